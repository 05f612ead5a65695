#include "cases/case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "cases/png_salt.hpp"
#include "core/file.hpp"
#include "volume/anatomy.hpp"

namespace tractus {
namespace cases {
namespace {

namespace fs = std::filesystem;
using core::bytes_of;
using core::Errc;
using testing::HasSubstr;

/// The smallest PNG there is: one grey pixel (PNG specification: signature, IHDR, IDAT, IEND).
constexpr unsigned char kPixel[] = {
    0x89, 'P',  'N',  'G',  13,   10,   26,   10,   0,    0,    0,    13,   'I',  'H',
    'D',  'R',  0,    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,
    0,    0x3a, 0x7e, 0x9b, 0x55, 0,    0,    0,    10,   'I',  'D',  'A',  'T',  0x78,
    0xda, 0x63, 0x60, 0x00, 0x00, 0x00, 0x02, 0x00, 0x01, 0x48, 0xaf, 0xa4, 0x71, 0,
    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};

volume::Volume small_volume() {
  volume::Volume v{.geometry = {{9, 8, 7}, {1e-3, 1e-3, 1e-3}, {0, 0, 0}, volume::Mat3::Identity()},
                   .slope = 1,
                   .intercept = -1024,
                   .counts = {}};
  for (std::size_t n = 0; n < v.geometry.voxel_count(); ++n) v.counts.push_back(std::uint16_t(n));
  return v;
}

class ACase : public testing::Test {
 protected:
  void SetUp() override {
    top_ = fs::temp_directory_path() /
           ("tractus_case_" + std::to_string(::getpid()) + "_" + core::new_id());
    fs::create_directories(top_);
    folder_ = top_ / "case";
    const auto written = write_case(folder_, made(), key_);
    ASSERT_TRUE(written) << written.error().what;
    id_ = written->id;
  }
  void TearDown() override { fs::remove_all(top_); }

  NewCase made() {
    const volume::Vec3 entry(0.005, 0.007, 0.003);
    Case definition{
        .title = "L3 left", .source = "made for a test", .made_utc_us = 1'700'000'000'000'000};
    definition.tract = *volume::tract_between(entry, {0.004, 0.001, 0.003}, 0.005, 0.0015,
                                              volume::stated_midline(0.0, entry));
    definition.model.name = "probe";
    Truth truth{.breached = volume::Wall::medial, .breach_m = volume::Vec3(0.1 / 3, 0.2, 0.3)};
    truth.breach_depth_m = 0.003;
    truth.wall_thickness_m = 0.0011;
    return {.definition = definition,
            .truth = truth,
            .volume = volume_,
            .meta = {},
            .draw = [](const fs::path& path) {
              return core::write_file(path, std::as_bytes(std::span(kPixel)));
            }};
  }

  std::string refusal() const {
    const auto opened = open_case(folder_);
    return opened ? "opened" : opened.error().what;
  }

  /// Flips one bit of a file.
  void flip(const char* name, std::size_t offset) {
    std::fstream file(folder_ / name, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = std::streamoff(offset % fs::file_size(folder_ / name));
    file.seekg(at);
    const int byte = file.get();
    file.seekp(at);
    file.put(char(byte ^ 1));
    ASSERT_TRUE(file.good());
  }

  const volume::Volume volume_ = small_volume();
  const core::KeyPair key_ = core::KeyPair::generate();
  fs::path top_, folder_;
  std::string id_;
};

TEST_F(ACase, OpensAsItWasMade) {
  const auto opened = open_case(folder_);
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(opened->id, id_);
  EXPECT_EQ(opened->id, core::sha256(*core::read_file(folder_ / "case.json")));
  EXPECT_EQ(opened->signer_public_hex, key_.public_hex);
  EXPECT_EQ(opened->definition.title, "L3 left");
  const auto expected = made();
  EXPECT_EQ(opened->definition.tract.axis, expected.definition.tract.axis);  // to the bit
  EXPECT_EQ(opened->definition.tract.superior, expected.definition.tract.superior);
  const auto stored = volume::VolumeFile::open(folder_ / "volume.tvol");
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->read_all()->counts, volume_.counts);
  const auto truth = read_truth(*opened);
  ASSERT_TRUE(truth) << truth.error().what;
  EXPECT_EQ(truth->breached, volume::Wall::medial);
  EXPECT_EQ(*truth->breach_m, volume::Vec3(0.1 / 3, 0.2, 0.3));
}

TEST_F(ACase, KeepsItsTruthOutOfTheOpenManifest) {
  const auto bytes = *core::read_file(folder_ / "case.json");
  const std::string manifest(core::text_of(bytes));
  EXPECT_THAT(manifest, testing::Not(HasSubstr("breach")));
  const auto opened = *open_case(folder_);
  for (const auto& part : opened.definition.parts)
    EXPECT_EQ(part.secret, part.name != "volume.tvol") << part.name;
}

TEST_F(ACase, HidesATruthThatCouldBeGuessedBehindItsSalt) {
  ASSERT_TRUE(write_case(top_ / "again", made(), key_));
  const auto a = open_case(folder_)->definition.parts,
             b = open_case(top_ / "again")->definition.parts;
  ASSERT_EQ(a.size(), 3u);
  for (std::size_t k = 0; k < a.size(); ++k)  // the same volume, the same truth, the same picture
    EXPECT_EQ(a[k].sha256 == b[k].sha256, !a[k].secret) << a[k].name;
}

TEST_F(ACase, HidesWhetherThereIsABreachFromTheSizesInTheManifest) {
  NewCase whole = made();
  whole.truth = {};
  whole.draw = [](const fs::path& path) {  // another picture: the pixel, a chunk more
    return core::write_file(path, *salted_png(std::as_bytes(std::span(kPixel)), "0123"));
  };
  ASSERT_TRUE(write_case(top_ / "whole", std::move(whole), key_));
  const auto broken = open_case(folder_)->definition.parts,
             intact = open_case(top_ / "whole")->definition.parts;
  ASSERT_EQ(broken.size(), intact.size());
  for (std::size_t k = 0; k < broken.size(); ++k)
    EXPECT_EQ(broken[k].size_bytes, intact[k].size_bytes) << broken[k].name;
  EXPECT_FALSE(read_truth(*open_case(top_ / "whole"))->breached);
}

TEST_F(ACase, OpensWithoutItsSecretParts) {
  fs::remove(folder_ / "truth.json");
  fs::remove(folder_ / "picture.png");
  const auto opened = open_case(folder_);
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(read_truth(*opened).error().code, Errc::not_found);
}

TEST_F(ACase, RefusesAnyManifestThatWasChanged) {
  const auto size = fs::file_size(folder_ / "case.json");
  for (std::size_t offset = 0; offset < size; offset += 97) {
    flip("case.json", offset);
    EXPECT_THAT(refusal(), HasSubstr("case.json: its signature does not hold")) << offset;
    flip("case.json", offset);
  }
  EXPECT_EQ(refusal(), "opened");
}

TEST_F(ACase, RefusesAnySignatureThatWasChanged) {
  const auto size = fs::file_size(folder_ / "case.sig");
  for (std::size_t offset = 0; offset < size; ++offset) {
    const auto bytes = *core::read_file(folder_ / "case.sig");
    const char byte = char(bytes[offset]);
    if (byte == ' ' || byte == '\n') continue;  // space between words
    flip("case.sig", offset);
    EXPECT_THAT(refusal(), testing::AnyOf(HasSubstr("case.sig"), HasSubstr("case.json"))) << offset;
    flip("case.sig", offset);
  }
}

TEST_F(ACase, RefusesEveryPartThatWasChangedByItsName) {
  for (const char* name : {"volume.tvol", "truth.json", "picture.png"}) {
    for (const std::size_t offset : {0u, 12u, 40u, 90u}) {
      flip(name, offset);
      EXPECT_THAT(refusal(),
                  HasSubstr(std::string(name) + ": its content is not what the case says"));
      flip(name, offset);
    }
    auto bytes = *core::read_file(folder_ / name);
    const auto whole = bytes;
    bytes.pop_back();
    ASSERT_TRUE(core::write_file(folder_ / name, bytes));
    EXPECT_THAT(refusal(), HasSubstr(std::string(name) + ": has "));
    ASSERT_TRUE(core::write_file(folder_ / name, whole));
  }
  EXPECT_EQ(refusal(), "opened");
}

TEST_F(ACase, RefusesAMissingOpenPartASurplusFileAndALink) {
  ASSERT_TRUE(core::write_file(folder_ / "notes.txt", bytes_of("medial!")));
  EXPECT_THAT(refusal(), HasSubstr("notes.txt: is not part of the case"));
  fs::remove(folder_ / "notes.txt");
  fs::rename(folder_ / "volume.tvol", top_ / "elsewhere.tvol");
  EXPECT_THAT(refusal(), HasSubstr("volume.tvol: is missing"));
  fs::create_symlink(top_ / "elsewhere.tvol", folder_ / "volume.tvol");
  EXPECT_THAT(refusal(), HasSubstr("volume.tvol: is not a regular file"));
}

TEST_F(ACase, RefusesAnotherCasesTruth) {
  ASSERT_TRUE(write_case(top_ / "other", made(), key_));
  const auto opened = open_case(folder_);
  fs::copy_file(top_ / "other" / "truth.json", folder_ / "truth.json",
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(), HasSubstr("truth.json: its content is not"));
  EXPECT_EQ(read_truth(*opened).error().code, Errc::corrupt);
}

TEST_F(ACase, RefusesAFolderWithoutManifestOrSignature) {
  EXPECT_EQ(open_case(top_).error().code, Errc::not_found);
  fs::remove(folder_ / "case.sig");
  EXPECT_THAT(refusal(), HasSubstr("case.sig: is missing"));
}

TEST_F(ACase, IsMadeWholeOrNotAtAll) {
  EXPECT_EQ(write_case(folder_, made(), key_).error().code, Errc::conflict);
  auto failing = made();
  failing.draw = [](const fs::path&) {
    return core::Result<void>(core::Error{Errc::io, "no ink"});
  };
  EXPECT_EQ(write_case(top_ / "new", failing, key_).error().what, "no ink");
  EXPECT_EQ(std::distance(fs::directory_iterator(top_), {}), 1);  // the first case alone
}

/// The refusal of a well-signed manifest with one member replaced: a signature does not make
/// nonsense true.
class AManifest : public ACase {
 protected:
  std::string refusal_with(const char* pointer, const core::Json& value) {
    auto json = *core::read_json(folder_ / "case.json");
    json[core::Json::json_pointer(pointer)] = value;
    const auto made = Case::from_json(json, "case.json: ");
    return made ? "taken" : made.error().what;
  }
};

TEST_F(AManifest, IsRefusedByTheFieldThatIsWrong) {
  EXPECT_EQ(refusal_with("/title", "another"), "taken");
  EXPECT_THAT(refusal_with("/format", "tractus-case/2"), HasSubstr("case.json: /format"));
  EXPECT_THAT(refusal_with("/parts/0/name", "../../volume.tvol"),
              HasSubstr("/parts/0/name: '../../volume.tvol'"));
  EXPECT_THAT(refusal_with("/parts/0/name", "case.sig"), HasSubstr("/parts/0/name"));
  EXPECT_THAT(refusal_with("/parts/0/name", "truth.json"), HasSubstr("is there twice"));
  EXPECT_THAT(refusal_with("/parts/0/secret", true), HasSubstr("an open part 'volume.tvol'"));
  EXPECT_THAT(refusal_with("/parts/1/secret", false), HasSubstr("a secret part 'truth.json'"));
  EXPECT_THAT(refusal_with("/parts/0/sha256", "ab"), HasSubstr("/parts/0/sha256"));
  EXPECT_THAT(refusal_with("/parts/0/size_bytes", -1), HasSubstr("/parts/0/size_bytes"));
  EXPECT_THAT(refusal_with("/tract/axis", {0, 0, 2}), HasSubstr("/tract/axis: a unit vector"));
  EXPECT_THAT(refusal_with("/tract/medial", {0, -1, 0}),
              HasSubstr("/tract/medial: must be perpendicular"));
  EXPECT_THAT(refusal_with("/tract/length_m", 0), HasSubstr("/tract/length_m: 0"));
  EXPECT_THAT(refusal_with("/model/base/length_m", -1),
              HasSubstr("case.json: /model/base/length_m: -1"));
  EXPECT_THAT(refusal_with("/truth", "medial"), HasSubstr("/truth: this field is not known"));
}

TEST(Truth, SaysAWallOnlyWithItsPlace) {
  const auto why = [](const char* pointer, const core::Json& value) {
    Truth truth{.breached = volume::Wall::superior, .breach_m = volume::Vec3(1, 2, 3)};
    truth.salt_hex = std::string(64, 'a');
    auto json = truth.to_json();
    json[core::Json::json_pointer(pointer)] = value;
    const auto read = Truth::from_json(json, "truth.json: ");
    return read ? "taken" : read.error().what;
  };
  EXPECT_EQ(why("/breach_depth_m", 0.002), "taken");
  EXPECT_THAT(why("/breached", "upwards"), HasSubstr("/breached: 'upwards' is not a wall"));
  EXPECT_THAT(why("/breach_m", nullptr), HasSubstr("/breach_m: a place is expected"));
  EXPECT_THAT(why("/breached", nullptr), HasSubstr("/breach_m: a place is expected"));
  EXPECT_THAT(why("/salt", "abc"), HasSubstr("/salt"));
}

TEST(SaltedPng, CarriesATextChunkWithItsChecksumBeforeTheEnd) {
  const auto salted = salted_png(std::as_bytes(std::span(kPixel)), "00");
  ASSERT_TRUE(salted);
  const auto text = core::text_of(*salted);
  // tEXt, keyword "salt", 0, "00"; its CRC-32 by zlib: zlib.crc32(b"tEXtsalt\0" b"00")
  const std::string chunk = std::string(
      "\0\0\0\x07tEXtsalt\0"
      "00",
      15);
  const auto at = text.find(chunk);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(core::hex(bytes_of(text.substr(at + 15, 4))), "e3579dec");
  EXPECT_TRUE(text.ends_with(std::string_view("IEND\xae\x42\x60\x82", 8)));
  EXPECT_FALSE(salted_png(bytes_of("GIF89a"), "00"));
}

}  // namespace
}  // namespace cases
}  // namespace tractus
