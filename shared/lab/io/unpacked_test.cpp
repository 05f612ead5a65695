#include "lab/io/unpacked.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace tractus {
namespace lab_io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class UnpackedTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tractus_unpacked_" + core::new_id());
    fs::create_directories(folder_ / "tmp");
    ::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);  // what others unpack meanwhile is not ours
  }
  void TearDown() override {
    ::unsetenv("TMPDIR");
    fs::remove_all(folder_);
  }

  struct Entry {
    std::string name, text;
    unsigned kind = AE_IFREG;
  };
  fs::path zip(const std::vector<Entry>& entries) {
    const fs::path path = folder_ / "set.zip";
    archive* writer = archive_write_new();
    archive_write_set_format_zip(writer);
    EXPECT_EQ(archive_write_open_filename(writer, path.c_str()), ARCHIVE_OK);
    for (const Entry& e : entries) {
      archive_entry* entry = archive_entry_new();
      archive_entry_set_pathname(entry, e.name.c_str());
      archive_entry_set_filetype(entry, e.kind);
      archive_entry_set_perm(entry, 0644);
      if (e.kind == AE_IFLNK) archive_entry_set_symlink(entry, e.text.c_str());
      archive_entry_set_size(entry, e.kind == AE_IFREG ? std::int64_t(e.text.size()) : 0);
      EXPECT_EQ(archive_write_header(writer, entry), ARCHIVE_OK);
      if (e.kind == AE_IFREG) archive_write_data(writer, e.text.data(), e.text.size());
      archive_entry_free(entry);
    }
    archive_write_free(writer);
    return path;
  }
  void expect_refused(const fs::path& path, const std::string& why,
                      const UnpackLimits& limits = {}) {
    const auto before = left_overs();
    const auto opened = Unpacked::open(path, limits);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().what, HasSubstr(why));
    EXPECT_EQ(opened.error().what.find('\n'), std::string::npos);
    EXPECT_EQ(left_overs(), before);
  }
  static std::size_t left_overs() {
    std::size_t n = 0;
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
      n += entry.path().filename().string().find("tractus-set") != std::string::npos;
    return n;
  }
  fs::path folder_;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(UnpackedTest, AFolderIsTakenAsItIs) {
  const auto opened = Unpacked::open(folder_);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->folder(), folder_);
}

TEST_F(UnpackedTest, AZipIsUnpackedAndGoesAway) {
  fs::path where;
  {
    const auto opened = Unpacked::open(zip({{"set.json", "{}"}, {"csv/a.csv", "t_s\n1\n"}}));
    ASSERT_TRUE(opened) << opened.error().what;
    where = opened->folder();
    EXPECT_EQ(text_of(where / "csv/a.csv"), "t_s\n1\n");
  }
  EXPECT_FALSE(fs::exists(where));
}

TEST_F(UnpackedTest, TheOnlyFolderOfAZipMayHoldTheSet) {
  const auto opened = Unpacked::open(zip({{"mine/set.json", "{}"}, {"mine/a.csv", "t_s\n"}}));
  ASSERT_TRUE(opened) << opened.error().what;
  EXPECT_EQ(opened->folder().filename(), "mine");
}

TEST_F(UnpackedTest, RefusesEntriesThatLeaveTheFolder) {
  expect_refused(zip({{"set.json", "{}"}, {"../escaped.csv", "x"}}), "'../escaped.csv' leaves");
  expect_refused(zip({{"set.json", "{}"}, {"a/../../escaped.csv", "x"}}), "leaves the folder");
  expect_refused(zip({{"set.json", "{}"}, {"/escaped.csv", "x"}}), "leaves the folder");
  expect_refused(zip({{"set.json", "{}"}, {std::string(256, 'a'), "x"}}), "more than 255 bytes");
  EXPECT_FALSE(fs::exists(fs::temp_directory_path() / "escaped.csv"));
}

TEST_F(UnpackedTest, RefusesLinksAndEntriesThatAreThereTwice) {
  expect_refused(zip({{"set.json", "{}"}, {"a.csv", "/etc/hostname", AE_IFLNK}}), "plain file");
  expect_refused(zip({{"set.json", "{}"}, {"set.json", "{}"}}), "is there twice");
}

TEST_F(UnpackedTest, StopsAtTheLimitsWhateverTheArchiveClaims) {
  expect_refused(zip({{"set.json", std::string(3 << 20, 'a')}}), "more than 1 MiB",
                 {.max_bytes = 1 << 20});
  expect_refused(zip({{"set.json", "{}"}, {"a", "x"}, {"b", "x"}}), "more than 2 files",
                 {.max_files = 2});
}

TEST_F(UnpackedTest, RefusesWhatIsNoSet) {
  expect_refused(zip({{"a.csv", "t_s\n"}}), "no set.json");
  expect_refused(folder_ / "nothing.zip", "not there");
  std::ofstream(folder_ / "text.zip") << "This is no archive.";
  expect_refused(folder_ / "text.zip", "text.zip: ");
  const fs::path whole = zip({{"set.json", std::string(20000, 'x')}});
  fs::resize_file(whole, 60);
  expect_refused(whole, "cannot be unpacked");
}

}  // namespace
}  // namespace lab_io
}  // namespace tractus
