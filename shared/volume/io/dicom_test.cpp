/// DICOM series in: every transfer syntax to the same voxels, geometry held against itself, and
/// what is refused.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <numbers>
#include <random>

#include "core/file.hpp"
#include "tests/support/dicom_writer.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/dicom_layout.hpp"
#include "volume/io/dicom_test_support.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using test_support::DicomSeries;
using test_support::Scratch;
using test_support::write_dicom_series;
using volume::Vec3;
using volume::Volume;
using volume_io::testing::expect_same;
using volume_io::testing::expect_word;
using volume_io::testing::phantom;
using volume_io::testing::thick;
namespace fs = std::filesystem;

class DicomSyntax : public testing::TestWithParam<test_support::Syntax> {};

TEST_P(DicomSyntax, GivesEveryVoxelWhereItWasPut) {
  const Volume v = phantom();
  for (const bool signed_pixels : {false, true}) {
    const Scratch folder;
    write_dicom_series(folder.path(), v,
                       {.transfer_syntax = GetParam().uid, .signed_pixels = signed_pixels});
    const auto in = volume_io::read_volume(folder.path());
    expect_same(in, v);
    EXPECT_TRUE(in->notes.empty());
    EXPECT_EQ(in->source, "DICOM series of 6 CT slices");
  }
}

INSTANTIATE_TEST_SUITE_P(All, DicomSyntax, testing::ValuesIn(test_support::kTransferSyntaxes),
                         [](const auto& named) { return std::string(named.param.name); });

TEST(Dicom, RescalesWithFractionalSlope) {
  Volume v = phantom();
  v.slope = 0.25;
  const Scratch folder;
  write_dicom_series(folder.path(), v);
  expect_same(volume_io::read_volume(folder.path()), v);
}

TEST(Dicom, SlicesScaledDifferentlyEachGetTheirOwnAndThatIsSaid) {
  const Volume v = phantom();
  const Scratch folder;
  write_dicom_series(folder.path(), v, {.slope_drift = 0.5});
  const auto in = volume_io::read_volume(folder.path());
  ASSERT_TRUE(in) << in.error().what;
  ASSERT_FALSE(in->notes.empty());
  EXPECT_NE(in->notes[0].find("differ between slices"), std::string::npos);
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(in->volume.value(3, 4, k), -1024.0 + (1.0 + 0.5 * k) * v.counts[v.offset(3, 4, k)],
                in->volume.slope)
        << k;
}

TEST(Dicom, ATiltedGantryIsUndoneAndThatIsSaid) {
  // A plane wave along the columns in patient space is shifted by tilted slices; upright, it is
  // where it was.
  Volume v = phantom();
  v.geometry.dims = {24, 20, 6};
  const double tilt = 15.0 * std::numbers::pi / 180.0;
  const double shift_px = 2e-3 * std::tan(tilt) / 0.8e-3;
  const auto wave = [](double j) { return 1000.0 + 40.0 * j; };
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 24; ++i)
        v.counts[v.offset(i, j, k)] =
            static_cast<std::uint16_t>(std::lround(wave(j + k * shift_px)));
  const Scratch folder;
  write_dicom_series(folder.path(), v, {.tilt_rad = tilt});
  const auto in = volume_io::read_volume(folder.path());
  ASSERT_TRUE(in) << in.error().what;
  ASSERT_EQ(in->notes.size(), 1u);
  EXPECT_NE(in->notes[0].find("15.00°"), std::string::npos) << in->notes[0];
  EXPECT_LT((in->volume.geometry.origin_m - v.geometry.origin_m).norm(), 1e-7);
  EXPECT_EQ(in->volume.geometry.dims[1], 20 + 4);  // 5 slices · 0.67 pixels = 3.35 more rows
  for (int k = 0; k < 6; ++k)
    for (int j = 5; j < 19; ++j)
      EXPECT_NEAR(in->volume.value(10, j, k), wave(j) - 1024.0, 1.01) << j << ' ' << k;
}

TEST(Dicom, OtherFilesInTheFolderAreLeftOutAndThatIsSaid) {
  const Scratch folder;
  write_dicom_series(folder.path(), phantom());
  test_support::put(folder / "readme.txt", core::bytes_of("hello"));
  const auto in = volume_io::read_volume(folder.path());
  expect_same(in, phantom());
  ASSERT_EQ(in->notes.size(), 1u);
  EXPECT_NE(in->notes[0].find("1 other"), std::string::npos);
}

/// Reads a series after something was done to its folder; the files are in slice order.
std::string refusal(const std::function<void(const fs::path&, const std::vector<fs::path>&)>& spoil,
                    const DicomSeries& how = {}) {
  const Scratch folder;
  const auto files = write_dicom_series(folder.path(), phantom(), how);
  spoil(folder.path(), files);
  const auto in = volume_io::read_volume(folder.path());
  EXPECT_FALSE(in);
  if (in) return "";
  EXPECT_EQ(in.error().what.find('\n'), std::string::npos);
  EXPECT_NE(in.error().what.find(folder.path().string()), std::string::npos) << in.error().what;
  return in.error().what;
}

/// Overwrites bytes of a file after the first place where `tag` stands, explicit little-endian.
void overwrite(const fs::path& path, std::uint16_t group, std::uint16_t element, std::size_t skip,
               const core::Bytes& with) {
  core::Bytes file = core::read_file(path).value();
  const std::array<std::byte, 4> tag{
      static_cast<std::byte>(group & 0xff), static_cast<std::byte>(group >> 8),
      static_cast<std::byte>(element & 0xff), static_cast<std::byte>(element >> 8)};
  const auto found = std::search(file.begin() + 132, file.end(), tag.begin(), tag.end());
  ASSERT_NE(found, file.end());
  std::ranges::copy(with, found + std::ptrdiff_t(skip));
  test_support::put(path, file);
}

const core::Bytes kHuge{std::byte{0xf0}, std::byte{0xff}, std::byte{0xff},
                        std::byte{0x7f}};  // 2147483632

TEST(Dicom, AMissingSliceIsRefusedNamingItsNeighbours) {
  std::string neighbour;
  const auto message = refusal([&](const fs::path&, const auto& files) {
    fs::remove(files[2]);
    neighbour = files[1].filename().string() + " and " + files[3].filename().string();
  });
  expect_word(message, neighbour + " lie 4 mm apart, the others 2 mm");
}

/// The phantom as series 2.25.314159265358979, and as 2.25.5 with 4 thick slices of it, in one folder.
void write_two_series(const fs::path& folder) {
  write_dicom_series(folder, phantom());
  write_dicom_series(folder, thick(), {.series_uid = "2.25.5", .prefix = "other"});
}

TEST(Dicom, TwoSeriesInAFolderAreRefusedWithAListOfThem) {
  const Scratch folder;
  write_two_series(folder.path());
  const auto in = volume_io::read_volume(folder.path());
  ASSERT_FALSE(in);
  // As the phantoms are made: 0.7 × 0.8 mm pixels (between rows first), slices 2 and 5 mm apart.
  EXPECT_EQ(in.error().what,
            folder.path().string() +
                ": holds 2 series; choose one by its Series Instance UID (tractus import --series "
                "UID, or series_uid of an upload): 2.25.314159265358979 (CT, 6 slices, pixels 0.8 "
                "× 0.7 mm, spacing 2 mm, thickness 2 mm); 2.25.5 (CT, 4 slices, pixels 0.8 × 0.7 "
                "mm, spacing 5 mm, thickness 5 mm)");
}

TEST(Dicom, AChosenSeriesIsReadAndTheOtherIsSaidToBeLeftOut) {
  const Scratch folder;
  write_two_series(folder.path());
  for (const auto& [uid, volume, note] :
       {std::tuple{"2.25.314159265358979", phantom(), "4 files of other series were left out"},
        std::tuple{"2.25.5", thick(), "6 files of other series were left out"}}) {
    const auto in = volume_io::read_volume(folder.path(), {.series_uid = uid});
    expect_same(in, volume);
    EXPECT_EQ(in->notes, std::vector<std::string>{note});
  }
}

TEST(Dicom, AnUnknownSeriesIsRefusedWithAListOfThoseThatThereAre) {
  const Scratch folder;
  write_two_series(folder.path());
  const auto in = volume_io::read_volume(folder.path(), {.series_uid = "2.25.6"});
  ASSERT_FALSE(in);
  expect_word(in.error().what,
              "holds no series 2.25.6; it holds 2.25.314159265358979 (CT, 6 slices");
  expect_word(in.error().what, "; 2.25.5 (CT, 4 slices");
  EXPECT_EQ(in.error().what.find('\n'), std::string::npos);
}

TEST(Dicom, DamageInASeriesThatIsNotChosenDoesNotMatter) {
  const Scratch folder;
  write_dicom_series(folder.path(), phantom());
  const auto others =
      write_dicom_series(folder.path(), thick(), {.series_uid = "2.25.5", .prefix = "other"});
  overwrite(others[1], 0x7fe0, 0x0010, 8, kHuge);
  expect_same(volume_io::read_volume(folder.path(), {.series_uid = "2.25.314159265358979"}),
              phantom());
  const auto in = volume_io::read_volume(folder.path(), {.series_uid = "2.25.5"});
  ASSERT_FALSE(in);
  expect_word(in.error().what, "element (7fe0,0010) at byte ");
}

TEST(Dicom, ASliceInTheSamePlaceTwiceIsRefused) {
  expect_word(refusal([](const fs::path& folder, const auto& files) {
                fs::copy(files[2], folder / "again.dcm");
              }),
              "lie in the same place");
}

TEST(Dicom, MixedOrientationsAreRefused) {
  const auto message = refusal([](const fs::path& folder, const auto&) {
    Volume turned = phantom();
    turned.geometry.directions = volume::Mat3::Identity();
    write_dicom_series(folder, turned, {.prefix = "x"});
  });
  expect_word(message, "has another orientation than im");
}

TEST(Dicom, MixedSizesAreRefused) {
  const auto message = refusal([](const fs::path& folder, const auto&) {
    Volume small = phantom();
    small.geometry.dims = {12, 20, 6};
    small.counts.resize(small.geometry.voxel_count());
    write_dicom_series(folder, small, {.prefix = "x"});
  });
  expect_word(message, "has 20 × 12 pixels, others than im");
}

TEST(Dicom, LyingRowsAreRefused) {
  const core::Bytes rows{std::byte{0xff}, std::byte{0x0f}};  // 4095
  expect_word(refusal([&](const fs::path&, const auto& files) {
                overwrite(files[3], 0x0028, 0x0010, 8, rows);
              }),
              "pixel data of 960 bytes, 4095 rows of 24 columns need 196560");
}

TEST(Dicom, LyingRowsOfCompressedSlicesAreRefused) {
  const core::Bytes rows{std::byte{0xff}, std::byte{0x0f}};
  for (const auto& syntax : test_support::kTransferSyntaxes) {
    const std::string_view name = syntax.name;
    if (!name.starts_with("jpeg")) continue;
    expect_word(refusal(
                    [&](const fs::path&, const auto& files) {
                      for (const auto& f : files) overwrite(f, 0x0028, 0x0010, 8, rows);
                    },
                    {.transfer_syntax = syntax.uid}),
                "its compressed image is 20 × 24, rows and columns say 4095 × 24");
  }
}

TEST(Dicom, LyingLengthsAreRefusedBeforeAnyoneTakesMemoryForThem) {
  expect_word(refusal([](const fs::path&, const auto& files) {
                overwrite(files[0], 0x7fe0, 0x0010, 8, kHuge);
              }),
              "element (7fe0,0010) at byte ");
  expect_word(refusal([](const fs::path&, const auto& files) {
                overwrite(files[0], 0x0009, 0x1001, 6, {std::byte{0xff}, std::byte{0xff}});
              }),
              "element (0009,1001) at byte ");
  expect_word(refusal([](const fs::path&, const auto& files) {
                overwrite(files[0], 0x0008, 0x1120, 8, kHuge);
              }),
              "element (0008,1120) at byte ");
}

TEST(Dicom, TruncatedAnywhereIsRefused) {
  const Scratch folder;
  const auto files = write_dicom_series(folder.path(), phantom());
  const core::Bytes whole = core::read_file(files[2]).value();
  for (std::size_t size = 133; size < whole.size(); size += 37) {
    test_support::put(files[2], core::ByteView(whole).first(size));
    EXPECT_FALSE(volume_io::read_volume(folder.path())) << size;
  }
}

TEST(Dicom, RandomDamageIsReadOrRefusedAndNothingElse) {
  std::mt19937 random(5);
  for (const auto& syntax : test_support::kTransferSyntaxes) {
    const Scratch folder;
    const auto files =
        write_dicom_series(folder.path(), phantom(), {.transfer_syntax = syntax.uid});
    const core::Bytes whole = core::read_file(files[2]).value();
    for (int n = 0; n < 20; ++n) {
      core::Bytes damaged = whole;
      for (int d = 0; d < 3; ++d)
        damaged[132 + random() % (damaged.size() - 132)] = static_cast<std::byte>(random());
      test_support::put(files[2], damaged);
      const auto in = volume_io::read_volume(folder.path());
      if (in)
        EXPECT_EQ(in->volume.counts.size(), in->volume.geometry.voxel_count());
      else
        EXPECT_EQ(in.error().what.find('\n'), std::string::npos) << in.error().what;
    }
  }
}

TEST(Dicom, AnEmptyFolderIsRefused) {
  const Scratch folder;
  const auto in = volume_io::read_volume(folder.path());
  ASSERT_FALSE(in);
  EXPECT_EQ(in.error().what, folder.path().string() + ": no DICOM file in this folder");
}

TEST(Dicom, OneSliceAloneOrByNameIsRefused) {
  expect_word(refusal([](const fs::path&, const auto& files) {
                for (std::size_t k = 1; k < files.size(); ++k) fs::remove(files[k]);
              }),
              "one slice alone");
  const Scratch folder;
  const auto files = write_dicom_series(folder.path(), phantom());
  const auto in = volume_io::read_volume(files[0]);
  ASSERT_FALSE(in);
  expect_word(in.error().what, "give the folder that holds the series");
}

TEST(Dicom, CodestreamsStateTheirOwnSize) {
  // By hand: JPEG start, an APP0 of 4 bytes, SOF3 with 513 lines of 258; J2K SIZ with image 300 ×
  // 200 offset by 44 × 0.
  const auto bytes = [](std::initializer_list<int> list) {
    core::Bytes out;
    for (const int b : list) out.push_back(static_cast<std::byte>(b));
    return out;
  };
  const auto jpeg =
      bytes({0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xc3, 0, 11, 16, 2, 1, 1, 2, 1, 1, 0x11, 0});
  EXPECT_EQ(volume_io::codestream_extent(jpeg),
            (std::pair<std::uint32_t, std::uint32_t>{513, 258}));
  const auto j2k = bytes(
      {0xff, 0x4f, 0xff, 0x51, 0, 41, 0, 0, 0, 0, 1, 44, 0, 0, 0, 200, 0, 0, 0, 44, 0, 0, 0, 0});
  EXPECT_EQ(volume_io::codestream_extent(j2k), (std::pair<std::uint32_t, std::uint32_t>{200, 256}));
  EXPECT_EQ(volume_io::codestream_extent(bytes({1, 2, 3, 4})),
            (std::pair<std::uint32_t, std::uint32_t>{0, 0}));
}

}  // namespace
}  // namespace tractus
