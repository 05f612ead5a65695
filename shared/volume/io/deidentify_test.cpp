/// De-identification by attribute: what of the standard's table is kept, replaced and removed.
#include "volume/io/deidentify.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/file.hpp"
#include "tests/support/dicom_writer.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/dicom_profile.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using core::Json;
using volume_io::Deidentifier;
using volume_io::UidKey;
namespace fs = std::filesystem;

volume::Volume block() {
  volume::Volume v;
  v.geometry.dims = {8, 8, 3};
  v.geometry.spacing_m = {1e-3, 1e-3, 1e-3};
  v.counts.assign(8 * 8 * 3, 100);
  return v;
}

/// A file of one slice without the patient; empty where it is refused.
core::Bytes one_cleaned(Deidentifier& deidentifier, core::ByteView file, const fs::path& path) {
  core::Bytes out;
  const auto done = deidentifier.cleaned(
      file, path, [&](std::size_t frame, core::ByteView slice) -> core::Result<void> {
        EXPECT_EQ(frame, 0u);
        out.assign(slice.begin(), slice.end());
        return {};
      });
  EXPECT_TRUE(done) << done.error().what;
  return out;
}

/// "done" of an attribute in a report.
std::string done(const Json& report, const std::string& tag) {
  for (const Json& attribute : report["attributes"])
    if (attribute["tag"] == tag) return attribute["done"];
  return "";
}

class Deidentify : public testing::TestWithParam<test_support::Syntax> {};

TEST_P(Deidentify, LeavesNothingPlantedInTheFileAnew) {
  const test_support::Scratch folder;
  const auto files =
      test_support::write_dicom_series(folder.path(), block(), {.transfer_syntax = GetParam().uid});
  Deidentifier deidentifier(UidKey{});
  for (const fs::path& path : files) {
    const auto file = core::read_file(path).value();
    const core::Bytes cleaned = one_cleaned(deidentifier, file, path);
    const std::string text(core::text_of(cleaned));
    for (const std::string& planted : test_support::kPlantedTexts)
      EXPECT_EQ(text.find(planted), std::string::npos) << planted;
    EXPECT_EQ(text.find("314159265358979"), std::string::npos) << "the series' identifier";
    EXPECT_NE(text.find("PS3.15"), std::string::npos) << "it says that it was de-identified";
    // What was cleaned is itself a file that can be cleaned.
    Deidentifier again(UidKey{});
    EXPECT_FALSE(one_cleaned(again, cleaned, path).empty());
  }
  const Json report = deidentifier.report();
  EXPECT_EQ(report["files"], 3);
  EXPECT_EQ(done(report, "(0010,0010)"), "removed");
  EXPECT_EQ(done(report, "(0009,xxxx)"), "removed");
  EXPECT_EQ(done(report, "(0020,000e)"), "new identifier");
  EXPECT_EQ(done(report, "(7fe0,0010)"), "kept");
  for (const Json& attribute : report["attributes"])
    if (attribute["tag"] == "(0010,0010)") {
      EXPECT_EQ(attribute["profile"], "Z");
      EXPECT_EQ(attribute["count"], 3);
      EXPECT_EQ(attribute["nested"], 3);
      EXPECT_EQ(attribute["name"], "Patient's Name");
    }
  for (const std::string& planted : test_support::kPlantedTexts)
    EXPECT_EQ(report.dump().find(planted), std::string::npos) << planted;
}

INSTANTIATE_TEST_SUITE_P(All, Deidentify, testing::ValuesIn(test_support::kTransferSyntaxes),
                         [](const auto& named) { return std::string(named.param.name); });

TEST(ReplacedUid, IsTheSameByTheSameKeyAloneAndAValidIdentifier) {
  UidKey one{}, two{};
  two[0] = std::byte{1};
  const std::string uid = "1.2.840.113619.2.55.3.604688119.969.1268071029.320";
  EXPECT_EQ(volume_io::replaced_uid(uid, one), volume_io::replaced_uid(uid, one));
  EXPECT_NE(volume_io::replaced_uid(uid, one), volume_io::replaced_uid(uid, two));
  EXPECT_NE(volume_io::replaced_uid(uid, one), volume_io::replaced_uid(uid + "1", one));
  for (int i = 0; i < 1000; ++i) {
    const std::string made = volume_io::replaced_uid(uid + std::to_string(i), one);
    EXPECT_LE(made.size(), 64u);  // PS3.5 section 9.1
    EXPECT_TRUE(made.starts_with("2.25."));
    EXPECT_NE(made[5], '0') << "no leading zero";
    EXPECT_EQ(made.find_first_not_of("0123456789.", 0), std::string::npos);
  }
}

/// Rows read from PS3.15 2024b, Table E.1-1, one of each action.
TEST(DicomProfile, HoldsTheTablesRows) {
  const std::pair<std::uint32_t, const char*> rows[] = {
      {0x00100010, "Z"},      // Patient's Name
      {0x00100020, "Z/D"},    // Patient ID, Z before 2024
      {0x00101040, "X"},      // Patient's Address
      {0x00080050, "Z"},      // Accession Number
      {0x00080080, "X/Z/D"},  // Institution Name
      {0x0020000d, "U"},      // Study Instance UID
      {0x00080018, "U"},      // SOP Instance UID
      {0x00080022, "X/Z"},    // Acquisition Date
      {0x0040a730, "D"},      // Content Sequence
      {0x00091001, "X"},      // private
      {0x60003000, "X"},      // overlay data
      {0x501e0010, "X"},      // curve data
      {0x00280010, ""},       // Rows
      {0x7fe00010, ""}};      // Pixel Data
  for (const auto& [tag, action] : rows)
    EXPECT_EQ(volume_io::profile_action(tag), action) << std::hex << tag;
}

/// The stricter table may keep nothing that the standard's removes, empties or replaces, but new
/// identifiers for old ones.
TEST(DicomProfile, KeepsNothingThatTheStandardDoesNot) {
  int kept = 0;
  for (std::uint32_t group :
       {0x0008u, 0x0010u, 0x0012u, 0x0018u, 0x0020u, 0x0028u, 0x0040u, 0x7fe0u})
    for (std::uint32_t e = 0; e < 0x10000; ++e) {
      const auto row = volume_io::kept_row(group << 16 | e);
      if (!row) continue;
      ++kept;
      const auto action = volume_io::profile_action(group << 16 | e);
      if (row->form == volume_io::Form::new_uid)
        EXPECT_EQ(action, "U") << std::hex << (group << 16 | e);
      else
        EXPECT_EQ(action, "") << std::hex << (group << 16 | e);
    }
  EXPECT_GT(kept, 20);
}

TEST(Deidentified, ImportSaysWhatItDidAndWhatItSuspects) {
  const test_support::Scratch folder;
  test_support::write_dicom_series(folder.path(), block());
  const auto in = volume_io::read_volume(folder.path());
  ASSERT_TRUE(in) << in.error().what;
  EXPECT_EQ(in->modality, "CT");
  EXPECT_TRUE(in->suspicions.empty());
  EXPECT_EQ(done(in->report, "(0010,0010)"), "removed");
  EXPECT_EQ(in->report["faces"], "not removed");
}

}  // namespace
}  // namespace tractus
