#include "db/store/volumes/objects.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "core/file.hpp"
#include "db/store/store_test_support.hpp"

namespace tractus {
namespace store {
namespace {
using testing::TestFolder;

// SHA-256 of "abc": FIPS 180-4, example B.1.
const std::string kAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
const std::string kUpload(32, '1');

std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    count += entry.is_regular_file() ? 1 : 0;
  return count;
}

TEST(Objects, AreNamedByTheirContent) {
  const TestFolder folder;
  const auto objects = std::move(Objects::open(folder.path()).value());
  auto name = objects.put(core::bytes_of("abc"));
  ASSERT_TRUE(name);
  EXPECT_EQ(*name, kAbc);
  EXPECT_EQ(objects.path_of(kAbc), folder.path() / "objects" / "ba" / kAbc.substr(2));
  EXPECT_EQ(core::text_of(core::read_file(objects.path_of(kAbc)).value()), "abc");
}

TEST(Objects, AFileThatIsNotWhatItIsSaidToBeIsNotTakenAndLeavesNothing) {
  const TestFolder folder;
  const auto objects = std::move(Objects::open(folder.path()).value());
  std::ofstream(folder.path() / "in") << "abd";
  auto taken = objects.copy_in(folder.path() / "in", kAbc);
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, core::Errc::corrupt);
  EXPECT_EQ(files_in(folder.path() / "objects"), 0u);
}

TEST(Objects, LinkingTwiceIsLinkingOnce) {
  const TestFolder folder;
  const auto objects = std::move(Objects::open(folder.path()).value());
  std::ofstream(folder.path() / "in") << "abc";
  EXPECT_TRUE(objects.link_in(folder.path() / "in", kAbc));
  EXPECT_TRUE(objects.link_in(folder.path() / "in", kAbc));
  EXPECT_TRUE(objects.has(kAbc));
  EXPECT_EQ(files_in(folder.path() / "objects"), 1u);
}

TEST(PartialFiles, GrowByPiecesAndSayHowMuchIsHere) {
  const TestFolder folder;
  const auto parts = std::move(PartialFiles::open(folder.path()).value());
  EXPECT_EQ(parts.size_of(kUpload), 0u);
  ASSERT_TRUE(parts.append(kUpload, 0, core::bytes_of("a")));
  ASSERT_TRUE(parts.append(kUpload, 1, core::bytes_of("bc")));
  EXPECT_EQ(parts.size_of(kUpload), 3u);
  EXPECT_EQ(file_sha256(parts.path_of(kUpload)).value(), kAbc);
  EXPECT_FALSE(parts.append(std::string(32, 'e'), 3, core::bytes_of("x")));  // has no beginning
}

// A file may be no longer than 1 KiB here: the piece that does not fit is taken back whole.
TEST(PartialFiles, AreAsLongAsBeforeAfterAWriteThatFailed) {
  const TestFolder folder;
  const auto parts = std::move(PartialFiles::open(folder.path()).value());
  ASSERT_TRUE(parts.append(kUpload, 0, core::bytes_of("abc")));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1024, before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = parts.append(kUpload, 3, core::Bytes(4096));
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(written);
  EXPECT_EQ(file_sha256(parts.path_of(kUpload)).value(), kAbc);
}

}  // namespace
}  // namespace store
}  // namespace tractus
