/// A patient planted in every attribute that DICOM knows, then searched for in everything that the
/// real server keeps, logs and answers.
#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <gdcmDicts.h>
#include <gdcmGlobal.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "tests/support/server/process.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

/// Every planted text begins so, every planted identifier so: 8 letters cannot stand in compressed
/// bytes by chance (2⁻⁶⁴ a place).
constexpr std::string_view kMark = "ZQXMARK.", kUidMark = "1.2.999.77770.";

std::string u16(unsigned v) { return {char(v & 255), char(v >> 8 & 255)}; }
std::string u32(std::size_t v) { return u16(unsigned(v & 0xffff)) + u16(unsigned(v >> 16)); }

/// Explicit little-endian, PS3.5 section 7.1.2; written here by hand, not by what is tested.
std::string element(unsigned tag, const std::string& vr, std::string value) {
  if (value.size() % 2) value += vr == "UI" || vr == "OB" || vr == "UN" ? '\0' : ' ';
  const bool long_form =
      std::string_view("OB OD OF OL OV OW SQ SV UC UN UR UT UV").find(vr) != std::string_view::npos;
  return u16(tag >> 16) + u16(tag & 0xffff) + vr +
         (long_form ? u16(0) + u32(value.size()) : u16(unsigned(value.size()))) + value;
}

std::string item(const std::string& elements) {
  return u16(0xfffe) + u16(0xe000) + u32(elements.size()) + elements;
}

/// A value that names its attribute: of a length that the representation allows.
std::string planted(unsigned tag, const std::string& vr) {
  if (vr == "UI") return std::string(kUidMark) + std::to_string(tag);
  const std::string text = std::string(kMark) + fmt::format("{:08x}", tag);
  if (vr == "SQ")  // the patient's name three deep, in items of defined length
    return item(element(0x00081120, "SQ",
                        item(element(0x00100010, "PN", text) +
                             element(0x00081115, "SQ", item(element(0x00100020, "LO", text))))) +
                element(0x00091010, "LO", text));
  return text;  // 16 bytes: also whole numbers of every binary representation
}

/// What a slice of a volume needs; 4 × 4 pixels of 16 bits.
std::map<unsigned, std::string> needed(int slice) {
  const auto us = [](unsigned v) { return u16(v); };
  std::string pixels;
  for (unsigned p = 0; p < 16; ++p) pixels += u16(1000 + 16 * unsigned(slice) + p);
  return {{0x00200032, element(0x00200032, "DS", fmt::format("0\\0\\{}", 2 * slice))},
          {0x00200037, element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")},
          {0x00280002, element(0x00280002, "US", us(1))},
          {0x00280004, element(0x00280004, "CS", "MONOCHROME2")},
          {0x00280008, element(0x00280008, "IS", "1")},
          {0x00280010, element(0x00280010, "US", us(4))},
          {0x00280011, element(0x00280011, "US", us(4))},
          {0x00280030, element(0x00280030, "DS", "1\\1")},
          {0x00280100, element(0x00280100, "US", us(16))},
          {0x00280101, element(0x00280101, "US", us(16))},
          {0x00280102, element(0x00280102, "US", us(15))},
          {0x00280103, element(0x00280103, "US", us(0))},
          {0x00281052, element(0x00281052, "DS", "-1024")},
          {0x00281053, element(0x00281053, "DS", "1")},
          {0x7fe00010, element(0x7fe00010, "OW", pixels)}};
}

struct Planted {
  std::string file;
  std::map<std::string, int> by_vr;
};

/// Every attribute of GDCM's dictionary of the standard, with the reader's needs as they must be.
Planted planted_file(int slice) {
  Planted out;
  std::map<unsigned, std::string> elements;
  const auto& dictionary = gdcm::Global::GetInstance().GetDicts().GetPublicDict();
  for (auto entry = dictionary.Begin(); entry != dictionary.End(); ++entry) {
    const unsigned tag = entry->first.GetElementTag();
    std::string vr = gdcm::VR::GetVRString(entry->second.GetVR());
    if (vr.size() != 2) vr = vr.substr(0, 2);  // "US_SS": the first that may be
    const unsigned group = tag >> 16;
    if (group < 8 || group >= 0xfffe || group % 2 == 1 || vr == "??" || vr == "IN") continue;
    elements[tag] = element(tag, vr, planted(tag, vr));
    ++out.by_vr[vr];
  }
  // Repeating groups, private ones and what may stand behind the pixels.
  for (const unsigned group : {0x5000u, 0x501eu, 0x6000u, 0x601eu})
    for (const unsigned e : {0x0022u, 0x2500u, 0x3000u, 0x4000u})
      elements[group << 16 | e] = element(group << 16 | e, "LO", planted(group << 16 | e, "LO"));
  for (const unsigned group : {0x0009u, 0x0029u, 0x7fe1u}) {
    const unsigned creator = group << 16 | 0x10;
    elements[creator] = element(creator, "LO", planted(creator, "LO"));
    for (const auto& [e, vr] : std::vector<std::pair<unsigned, std::string>>{
             {0x1001, "LO"}, {0x1002, "SQ"}, {0x1003, "UN"}, {0x1004, "OB"}, {0x1005, "UI"}})
      elements[group << 16 | e] = element(group << 16 | e, vr, planted(group << 16 | e, vr));
  }
  elements[0xfffcfffc] = element(0xfffcfffc, "OB", planted(0xfffcfffc, "OB"));
  // Identifiers of the slice's own; one series for both slices.
  elements[0x00080018] = element(0x00080018, "UI", std::string(kUidMark) + std::to_string(slice));
  for (auto& [tag, bytes] : needed(slice)) elements[tag] = std::move(bytes);

  std::string meta = element(0x00020001, "OB", std::string("\0\1", 2)) +
                     element(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2") +
                     element(0x00020003, "UI", std::string(kUidMark) + "3") +
                     element(0x00020010, "UI", "1.2.840.10008.1.2.1") +
                     element(0x00020012, "UI", std::string(kUidMark) + "12");
  for (const unsigned e : {0x13u, 0x16u, 0x17u, 0x18u})
    meta += element(0x00020000 | e, "AE", planted(0x00020000 | e, "AE"));
  meta += element(0x00020100, "UI", std::string(kUidMark) + "100");
  meta += element(0x00020102, "OB", planted(0x00020102, "OB"));
  std::string preamble = std::string(kMark) + "preamble";
  preamble.resize(128, 'Z');
  out.file = preamble + "DICM" + element(0x00020000, "UL", u32(meta.size())) + meta;
  for (const auto& [tag, bytes] : elements) out.file += bytes;
  return out;
}

std::string zip_of(const std::map<std::string, std::string>& files) {
  std::string out(32u << 20, '\0');
  std::size_t used = 0;
  archive* writer = archive_write_new();
  archive_write_set_format_zip(writer);
  EXPECT_EQ(archive_write_open_memory(writer, out.data(), out.size(), &used), ARCHIVE_OK);
  for (const auto& [name, bytes] : files) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    EXPECT_EQ(archive_write_header(writer, entry), ARCHIVE_OK);
    archive_write_data(writer, bytes.data(), bytes.size());
    archive_entry_free(entry);
  }
  EXPECT_EQ(archive_write_close(writer), ARCHIVE_OK);
  archive_write_free(writer);
  out.resize(used);
  return out;
}

/// Does anything planted stand in the bytes, in whatever case?
bool holds_a_mark(std::string bytes) {
  if (bytes.find(kUidMark) != std::string::npos) return true;
  std::ranges::transform(bytes, bytes.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  return bytes.find("ZQXMAR") != std::string::npos;
}

class PlantedPatient : public ::testing::Test {
 protected:
  void answered(const Answer& answer) {
    ++answers_;
    EXPECT_FALSE(holds_a_mark(answer.body)) << answer.body.substr(0, 2000);
    for (const auto& [name, value] : answer.headers) EXPECT_FALSE(holds_a_mark(value)) << name;
  }
  Answer ask(const std::string& method, const std::string& path, const std::string& body = "") {
    Headers headers = admin_;
    headers["content-type"] =
        body.starts_with("{") ? "application/json" : "application/octet-stream";
    const Answer answer = client_.ask(method, "/api/v1" + path, headers, body);
    answered(answer);
    return answer;
  }
  /// Every file under the data folder, byte for byte.
  void search_files(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      ++files_;
      const auto bytes = core::read_file(entry.path());
      ASSERT_TRUE(bytes) << bytes.error().what;
      EXPECT_FALSE(holds_a_mark(std::string(core::text_of(*bytes)))) << entry.path();
      EXPECT_FALSE(holds_a_mark(entry.path().string()));
    }
  }
  Headers admin_;
  Client client_;
  int answers_ = 0, files_ = 0;
};

TEST_F(PlantedPatient, IsFoundInNothingThatTheServerKeepsLogsOrAnswers) {
  const Planted first = planted_file(0), second = planted_file(1);
  int attributes = 0;
  for (const auto& [vr, count] : first.by_vr) attributes += count;
  // Every representation of PS3.5 table 6.2-1 that GDCM 3.0 knows attributes of.
  for (const char* vr :
       {"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO", "LT", "OB", "OF",
        "OW", "PN", "SH", "SL", "SQ", "SS", "ST", "TM", "UC", "UI", "UL", "UR", "US", "UT"})
    EXPECT_TRUE(first.by_vr.contains(vr)) << vr;
  EXPECT_GT(attributes, 3000);
  EXPECT_TRUE(holds_a_mark(first.file));
  const std::string zip = zip_of({{"ZQXMARK.PATIENT/ZQXMARK.1", first.file},
                                  {"ZQXMARK.PATIENT/ZQXMARK.2", second.file},
                                  {"ZQXMARK.PATIENT/ZQXMARK.txt", "ZQXMARK.notes"}});

  const ServedWorld world;
  ServerProcess server(world.data, {"--log-requests"});
  client_.speak_to(server.port());
  admin_ = world.admin(client_);
  const Answer made = ask("POST", "/volumes?name=planted&source=simulated", zip);
  ASSERT_EQ(made.status, 201) << made.body;
  EXPECT_EQ(made.json()["dims"], core::Json({4, 4, 2}));
  const std::string id = made.json()["id"];
  const Answer report = ask("GET", "/volumes/" + id + "/report");
  std::size_t removed = 0;
  const core::Json reported = report.json();
  for (const auto& attribute : reported["attributes"])
    removed += attribute["done"] == "removed" ? 1 : 0;
  EXPECT_GT(removed, 3000u);
  ask("GET", "/volumes");
  ask("GET", "/volumes/" + id + "/slice?axis=axial");
  ask("GET", "/volumes/" + id + "/preview");
  EXPECT_EQ(ask("POST", "/volumes/" + id + "/release", "{\"looked_at\":true}").status, 200);
  ask("GET", "/audit?limit=100");

  // Files that are refused: cut in the midst, and with a word where numbers are needed.
  std::string worded = first.file;
  worded.replace(worded.find("-1024 "), 6, "ZQXMAR");
  for (const std::string& bad : {first.file.substr(0, first.file.size() / 2), worded}) {
    const Answer refused =
        ask("POST", "/volumes?name=bad", zip_of({{"ZQXMARK.3", bad}, {"ZQXMARK.4", second.file}}));
    EXPECT_EQ(refused.status, 400) << refused.body;
  }
  EXPECT_EQ(server.stop(), 0);
  EXPECT_FALSE(holds_a_mark(server.output())) << server.output().substr(0, 2000);
  search_files(world.data);
  std::printf("planted: %d attributes of %zu representations; searched: %d files, %d answers\n",
              attributes, first.by_vr.size(), files_, answers_);
  EXPECT_GT(files_, 5);
  for (const auto& left : fs::recursive_directory_iterator(world.data / "scratch"))
    EXPECT_TRUE(left.is_directory() || left.path().filename() == "serving.lock") << left.path();
  // What is kept is the pixels, where they were.
  const std::string sha = [&] {
    for (const auto& entry : fs::recursive_directory_iterator(world.data / "objects")) {
      const auto file = volume::VolumeFile::open(entry.path());
      if (file && file->geometry().dims == std::array{4, 4, 2}) return entry.path().string();
    }
    return std::string();
  }();
  ASSERT_FALSE(sha.empty());
  const auto kept = volume::VolumeFile::open(sha)->read_all();
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->value(3, 2, 1), -1024 + 1000 + 16 + 4 * 2 + 3);
}

}  // namespace
}  // namespace tractus
