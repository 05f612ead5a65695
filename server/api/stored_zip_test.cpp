#include "server/api/stored_zip.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "core/bytes.hpp"
#include "db/store/store_test_support.hpp"

namespace tractus {
namespace api {
namespace {

/// Byte i of entry n is (i / 7 + n) mod 251, given out in pieces of 1000 bytes.
char byte_of(std::size_t entry, std::uint64_t i) {
  return static_cast<char>((i / 7 + entry) % 251);
}

class Pattern : public EntryContent {
 public:
  Pattern(std::size_t entry, std::uint64_t size) : entry_(entry), size_(size) {}
  core::Result<void> append_to(std::string& out) override {
    for (int i = 0; i < 1000 && at_ < size_; ++i) out += byte_of(entry_, at_++);
    return {};
  }

 private:
  std::size_t entry_;
  std::uint64_t size_, at_ = 0;
};

std::vector<StoredEntry> some_entries() {
  return {{"a.csv", 10}, {"empty.csv", 0}, {"samples/b.npy", 5000}, {"samples/c.npy", 1}};
}

OpenEntry patterns(std::vector<StoredEntry> entries) {
  return [entries](std::size_t i) -> core::Result<std::unique_ptr<EntryContent>> {
    return std::unique_ptr<EntryContent>(std::make_unique<Pattern>(i, entries[i].size));
  };
}

core::Result<std::string> part_of(const std::shared_ptr<StoredZip>& zip, const OpenEntry& open,
                                  std::uint64_t first, std::uint64_t size) {
  StoredZipSource source(zip, open, first, size);
  std::string out, piece;
  while (out.size() < size) {
    const auto read = source.read(piece);
    if (!read) return read.error();
    out += piece;
  }
  return out;
}

struct Said {
  int status;
  std::string text;
};
Said run(const std::string& command) {
  std::FILE* out = ::popen((command + " 2>&1").c_str(), "r");
  std::string said;
  std::array<char, 4096> piece{};
  while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), out))
    said.append(piece.data(), n);
  return {::pclose(out), said};
}
bool is_installed(const std::string& program) { return run("command -v " + program).status == 0; }

class StoredZipFile : public ::testing::Test {
 protected:
  store::testing::TestFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "made.zip";
};

TEST_F(StoredZipFile, InfoZipAndPythonReadIt) {
  const auto entries = some_entries();
  const auto zip = std::make_shared<StoredZip>(entries);
  const auto bytes = part_of(zip, patterns(entries), 0, zip->size());
  ASSERT_TRUE(bytes) << bytes.error().what;
  std::ofstream(path_, std::ios::binary) << *bytes;
  int peers = 0;
  if (is_installed("unzip")) {
    const Said tested = run("unzip -t " + path_.string());
    EXPECT_EQ(tested.status, 0) << tested.text;
    ++peers;
  }
  if (is_installed("python3")) {
    const Said listed =
        run("python3 -c \"import sys, zipfile\nfile = zipfile.ZipFile(sys.argv[1])\n"
            "assert file.testzip() is None\nfor n, one in enumerate(file.infolist()):\n"
            "  wanted = bytes((i // 7 + n) % 251 for i in range(one.file_size))\n"
            "  print(one.filename, one.file_size, file.read(one) == wanted, one.date_time[0])\" " +
            path_.string());
    EXPECT_EQ(listed.text,
              "a.csv 10 True 1980\nempty.csv 0 True 1980\nsamples/b.npy 5000 True 1980\n"
              "samples/c.npy 1 True 1980\n");
    ++peers;
  }
  if (peers == 0) GTEST_SKIP() << "neither unzip nor python3 is installed";
}

TEST_F(StoredZipFile, APartIsThatPartOfTheWhole) {
  const auto entries = some_entries();
  const OpenEntry open = patterns(entries);
  const auto known = std::make_shared<StoredZip>(entries);
  const std::string whole = part_of(known, open, 0, known->size()).value();
  for (std::uint64_t first = 0; first < whole.size(); first += 13) {
    const auto zip = std::make_shared<StoredZip>(entries);
    const bool in_directory = first >= zip->directory_begin();
    const auto before = in_directory ? entries.size() : zip->entry_at(first);
    ASSERT_TRUE(note_checksums_before(*zip, before, open, {}));
    EXPECT_EQ(part_of(zip, open, first, whole.size() - first).value(), whole.substr(first));
    const std::uint64_t some = std::min<std::uint64_t>(100, whole.size() - first);
    EXPECT_EQ(part_of(zip, open, first, some).value(), whole.substr(first, some));
  }
}

/// The contents are holes of a sparse file; Python reads where they are, and how long.
TEST_F(StoredZipFile, LargeEntriesAndPlacesAreZip64) {
  if (!is_installed("python3")) GTEST_SKIP() << "python3 is not installed";
  // Sizes on both sides of the largest that four bytes can state; then one that begins beyond it.
  const std::vector<StoredEntry> entries{
      {"a", 0xFFFF'FFFE}, {"b", 0xFFFF'FFFF}, {"c", std::uint64_t{5} << 30}, {"d", 1}};
  const StoredZip zip(entries);
  // Of the last, which is read whole: CRC-32 of one zero byte, by zlib.crc32(b"\0").
  const auto crc32 = [&](std::size_t i) { return i + 1 == entries.size() ? 0xD202EF8D : 0u; };
  {
    std::ofstream out(path_, std::ios::binary);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      out.seekp(static_cast<std::streamoff>(zip.begin_of(i)));
      out << zip.header(i);
      out.seekp(static_cast<std::streamoff>(entries[i].size), std::ios::cur);
      out << zip.descriptor(i, crc32(i));
    }
    ASSERT_EQ(static_cast<std::uint64_t>(out.tellp()), zip.directory_begin());
    for (std::size_t i = 0; i < entries.size(); ++i) out << zip.directory_record(i, crc32(i));
    out << zip.end_of_directory();
    ASSERT_EQ(static_cast<std::uint64_t>(out.tellp()), zip.size());
  }
  const Said listed =
      run("python3 -c \"import sys, zipfile\nfile = zipfile.ZipFile(sys.argv[1])\n"
          "for one in file.infolist():\n"
          "  print(one.filename, one.file_size, one.header_offset, file.open(one).read(1))\" " +
          path_.string());
  // By hand: an entry takes 31 bytes of header, 16 of descriptor; with ZIP64 20 and 8 more.
  EXPECT_EQ(listed.text,
            "a 4294967294 0 b'\\x00'\nb 4294967295 4294967341 b'\\x00'\n"
            "c 5368709120 8589934711 b'\\x00'\nd 1 13958643906 b'\\x00'\n");
}

TEST_F(StoredZipFile, ManyEntriesAreZip64) {
  if (!is_installed("python3")) GTEST_SKIP() << "python3 is not installed";
  std::vector<StoredEntry> entries;
  for (int i = 0; i < 70'000; ++i) entries.push_back({fmt::format("{:05}", i), 3});
  const auto zip = std::make_shared<StoredZip>(entries);
  std::ofstream(path_, std::ios::binary) << part_of(zip, patterns(entries), 0, zip->size()).value();
  const Said listed =
      run("python3 -c \"import sys, zipfile\nfile = zipfile.ZipFile(sys.argv[1])\n"
          "print(len(file.infolist()), file.read('00000').hex(), file.read('69999').hex())\" " +
          path_.string());
  EXPECT_EQ(listed.text, "70000 000000 dddddd\n");  // 69999 mod 251 = 221
}

TEST(StoredZip, AContentOfAnotherSizeEndsIt) {
  const auto zip = std::make_shared<StoredZip>(some_entries());
  for (const std::uint64_t size : {std::uint64_t{4999}, std::uint64_t{5001}}) {
    auto entries = some_entries();
    entries[2].size = size;
    const auto part = part_of(zip, patterns(entries), 0, zip->size());
    ASSERT_FALSE(part) << size;
    EXPECT_EQ(part.error().code, core::Errc::corrupt);
    EXPECT_TRUE(part.error().what.starts_with("samples/b.npy: 5000 bytes were expected"));
  }
}

TEST(StoredZip, AContentThatChangedEndsIt) {
  const auto zip = std::make_shared<StoredZip>(some_entries());
  ASSERT_TRUE(zip->note_checksum(0, 1));
  const auto part = part_of(zip, patterns(some_entries()), 0, zip->size());
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().what, "a.csv: its content changed");
}

}  // namespace
}  // namespace api
}  // namespace tractus
