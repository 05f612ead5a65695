/// Files of several slices (enhanced CT) and deflated files: the same voxels in the same places as
/// of a classic series, the same checks, and no patient.
#include "volume/io/dicom_frames.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "core/file.hpp"
#include "tests/support/dicom_writer.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/deidentify.hpp"
#include "volume/io/dicom_files.hpp"
#include "volume/io/dicom_test_support.hpp"

namespace tractus {
namespace {
using test_support::Scratch;
using test_support::write_enhanced_ct;
using volume_io::read_volume;
using volume_io::testing::expect_same;
using volume_io::testing::expect_word;
using volume_io::testing::phantom;
using volume_io::testing::thick;
namespace fs = std::filesystem;

/// Of the phantom's 6 slices, in an order that is not that of their places.
const std::vector<int> kOrder{4, 1, 5, 0, 3, 2};

class EnhancedSyntax : public testing::TestWithParam<test_support::Syntax> {};

TEST_P(EnhancedSyntax, GivesEveryVoxelWhereItWasPut) {
  for (const bool signed_pixels : {false, true}) {
    const Scratch folder;
    const auto file =
        write_enhanced_ct(folder / "ct.dcm", phantom(), kOrder,
                          {.transfer_syntax = GetParam().uid, .signed_pixels = signed_pixels});
    const auto in = read_volume(file);
    expect_same(in, phantom());
    EXPECT_TRUE(in->notes.empty());
    EXPECT_EQ(in->source, "DICOM series of 6 CT slices");
    expect_same(read_volume(folder.path()), phantom());
  }
}

INSTANTIATE_TEST_SUITE_P(All, EnhancedSyntax, testing::ValuesIn(test_support::kTransferSyntaxes),
                         [](const auto& named) { return std::string(named.param.name); });

TEST(EnhancedCt, FramesScaledDifferentlyEachGetTheirOwn) {
  const Scratch folder;
  const auto v = phantom();
  const auto in =
      read_volume(write_enhanced_ct(folder / "ct.dcm", v, kOrder, {.slope_drift = 0.5}));
  ASSERT_TRUE(in) << in.error().what;
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(in->volume.value(3, 4, k), -1024.0 + (1.0 + 0.5 * k) * v.counts[v.offset(3, 4, k)],
                in->volume.slope)
        << k;
}

TEST(EnhancedCt, FilesOfOneSeriesAreReadTogether) {
  const Scratch folder;
  write_enhanced_ct(folder / "a.dcm", phantom(), {5, 1, 3});
  write_enhanced_ct(folder / "b.dcm", phantom(), {0, 4, 2});
  expect_same(read_volume(folder.path()), phantom());
}

TEST(EnhancedCt, AMissingFrameIsRefusedNamingItsNeighbours) {
  const Scratch folder;
  const auto in = read_volume(write_enhanced_ct(folder / "ct.dcm", phantom(), {4, 1, 5, 0, 3}));
  ASSERT_FALSE(in);
  expect_word(in.error().what,
              folder.path().string() +
                  ": ct.dcm frame 0002 and ct.dcm frame 0005 lie 4 mm apart, the others 2 mm");
}

TEST(EnhancedCt, AFrameInTheSamePlaceTwiceIsRefused) {
  const Scratch folder;
  const auto in = read_volume(write_enhanced_ct(folder / "ct.dcm", phantom(), {0, 1, 2, 2, 3}));
  ASSERT_FALSE(in);
  expect_word(in.error().what, "lie in the same place");
}

TEST(EnhancedCt, TwoSeriesAreListedWithTheirSlices) {
  const Scratch folder;
  write_enhanced_ct(folder / "a.dcm", phantom(), kOrder);
  write_enhanced_ct(folder / "b.dcm", thick(), {0, 1, 2, 3}, {.series_uid = "2.25.5"});
  const auto in = read_volume(folder.path());
  ASSERT_FALSE(in);
  expect_word(in.error().what, "2.25.5 (CT, 4 slices, pixels 0.8 × 0.7 mm, spacing 5 mm");
  expect_same(read_volume(folder.path(), {.series_uid = "2.25.5"}), thick());
}

/// Reads an enhanced CT in which `from` was replaced by `to`, of the same length.
std::string refusal_of_spoilt(const std::string& from, const std::string& to) {
  const Scratch folder;
  const auto path = write_enhanced_ct(folder / "ct.dcm", phantom(), kOrder);
  std::string file(core::text_of(core::read_file(path).value()));
  for (std::size_t at = file.find(from); at != std::string::npos; at = file.find(from, at + 1))
    file.replace(at, from.size(), to);
  test_support::put(path, core::bytes_of(file));
  const auto in = read_volume(path);
  EXPECT_FALSE(in);
  if (in) return "";
  EXPECT_EQ(in.error().what.find('\n'), std::string::npos);
  return in.error().what;
}

TEST(EnhancedCt, WhatCannotBePlacedIsRefusedWithWhatToDo) {
  using namespace std::string_literals;
  // Elements as bytes, little-endian: the number of frames; the sequences of places, of each frame's
  // groups, of orientations.
  expect_word(refusal_of_spoilt("\x28\0\x08\0IS\x02\0"s + "6 ", "\x28\0\x08\0IS\x02\0"s + "7 "),
              "places for 6 frames, which is not their number: export it");
  expect_word(refusal_of_spoilt("\x00\x52\x30\x92SQ"s, "\x00\x52\x31\x92SQ"s),
              "6 frames in one file, which states no place for each: export it from the scanner");
  for (const char macro : {'\x13', '\x16'})
    expect_word(refusal_of_spoilt("\x20\0"s + macro + "\x91SQ", "\x20\0\x7f\x91SQ"s),
                "ct.dcm frame 0001: no image position, orientation or pixel spacing");
}

TEST(EnhancedCt, LeavesNothingPlantedInItsSlices) {
  const Scratch folder;
  const auto path = write_enhanced_ct(folder / "ct.dcm", phantom(), kOrder);
  const auto file = core::read_file(path).value();
  volume_io::Deidentifier deidentifier(volume_io::UidKey{});
  std::size_t slices = 0;
  const auto done = deidentifier.cleaned(
      file, path, [&](std::size_t frame, core::ByteView slice) -> core::Result<void> {
        EXPECT_EQ(frame, ++slices);
        for (const std::string& planted : test_support::kPlantedTexts)
          EXPECT_EQ(core::text_of(slice).find(planted), std::string::npos) << planted;
        return {};
      });
  ASSERT_TRUE(done) << done.error().what;
  EXPECT_EQ(slices, 6u);
  for (const core::Json& attribute : deidentifier.report()["attributes"]) {
    if (attribute["tag"] == "(0020,0032)") {
      EXPECT_EQ(attribute["done"], "kept");
      EXPECT_EQ(attribute["nested"], 6);
    }
    if (attribute["tag"] == "(0020,9158)") {
      EXPECT_EQ(attribute["done"], "removed");
    }
  }
}

TEST(EnhancedCt, RandomDamageIsReadOrRefusedAndNothingElse) {
  std::mt19937 random(7);
  for (const char* syntax : {"1.2.840.10008.1.2.1", "1.2.840.10008.1.2.4.80"}) {
    const Scratch folder;
    const auto path =
        write_enhanced_ct(folder / "ct.dcm", phantom(), kOrder, {.transfer_syntax = syntax});
    const core::Bytes whole = core::read_file(path).value();
    for (int n = 0; n < 40; ++n) {
      core::Bytes damaged = whole;
      for (int d = 0; d < 3; ++d)
        damaged[132 + random() % (damaged.size() - 132)] = static_cast<std::byte>(random());
      test_support::put(path, damaged);
      const auto in = read_volume(path);
      if (in)
        EXPECT_EQ(in->volume.counts.size(), in->volume.geometry.voxel_count());
      else
        EXPECT_EQ(in.error().what.find('\n'), std::string::npos) << in.error().what;
    }
  }
}

/// The data set behind the meta information deflated (PS3.5 A.5) by zlib.
core::Bytes deflated(core::ByteView file) {
  const auto meta = volume_io::parse_dicom_meta(file, "a test's file");
  EXPECT_TRUE(meta);
  const auto set = file.subspan(meta->end);
  z_stream stream{};
  EXPECT_EQ(::deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  core::Bytes packed(::deflateBound(&stream, set.size()));
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(set.data()));
  stream.avail_in = static_cast<unsigned>(set.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<unsigned>(packed.size());
  EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out + stream.total_out % 2);
  ::deflateEnd(&stream);
  // Its transfer syntax element alone as meta information: explicit, 22 bytes of UID.
  constexpr std::string_view kSyntax(
      "\x02\x00\x10\x00UI\x16\x00"
      "1.2.840.10008.1.2.1.99",
      30);
  core::Bytes out(128, std::byte{0});
  for (const std::string_view part : {std::string_view("DICM"), kSyntax})
    std::ranges::copy(core::bytes_of(part), std::back_inserter(out));
  out.insert(out.end(), packed.begin(), packed.end());
  return out;
}

TEST(DeflatedDicom, GivesTheSameVoxels) {
  const Scratch folder;
  for (const auto& path : test_support::write_dicom_series(folder.path(), phantom()))
    test_support::put(path, deflated(core::read_file(path).value()));
  expect_same(read_volume(folder.path()), phantom());
}

TEST(DeflatedDicom, TruncatedOrDamagedIsRefused) {
  const Scratch folder;
  const auto files = test_support::write_dicom_series(folder.path(), phantom());
  const core::Bytes packed = deflated(core::read_file(files[1]).value());
  test_support::put(files[1], core::ByteView(packed).first(packed.size() / 2));
  const auto in = read_volume(folder.path());
  ASSERT_FALSE(in);
  expect_word(in.error().what, "its deflated data set is damaged or not whole");
}

TEST(DeflatedDicom, ABombIsRefusedBeforeItTakesMemory) {
  const Scratch folder;
  core::Bytes zeros(300u << 20);  // deflates about 1000 : 1
  const auto files = test_support::write_dicom_series(folder.path(), phantom());
  const core::Bytes head = core::read_file(files[0]).value();
  std::ranges::copy(head, zeros.begin());
  test_support::put(files[0], deflated(zeros));
  volume_io::DicomFiles reader;
  const auto read = reader.read(files[0]);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, core::Errc::too_large);
  expect_word(read.error().what, "inflates to over 64 MiB");
}

}  // namespace
}  // namespace tractus
