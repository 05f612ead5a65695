#include "db/store/volumes/objects.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>

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
  EXPECT_EQ(objects.size_of(kAbc).value(), 3u);
  EXPECT_EQ(files_in(folder.path() / "objects"), 1u);
}

/// Objects kept in a map, which may be out of reach.
class MapStore final : public ObjectStore {
 public:
  core::Result<void> put(const std::string& sha256,
                         const std::filesystem::path& file) const override {
    if (away) return gone();
    kept[sha256] = std::string(core::text_of(core::read_file(file).value()));
    return {};
  }
  core::Result<void> read(const std::string& sha256, std::uint64_t offset,
                          std::optional<std::uint64_t> size, const Take& take) const override {
    if (away) return gone();
    ++reads;
    if (!kept.contains(sha256)) return core::Error{core::Errc::not_found, "no object"};
    const auto bytes = core::bytes_of(kept[sha256]).subspan(offset);
    take(size ? bytes.first(*size) : bytes);
    return {};
  }
  core::Result<std::optional<std::uint64_t>> size_of(const std::string& sha256) const override {
    if (away) return gone();
    return kept.contains(sha256) ? std::optional<std::uint64_t>(kept[sha256].size()) : std::nullopt;
  }
  core::Result<void> remove(const std::string& sha256) const override {
    if (away) return gone();
    kept.erase(sha256);
    return {};
  }
  static core::Error gone() { return {core::Errc::unavailable, "away"}; }
  mutable std::map<std::string, std::string> kept;
  mutable int reads = 0;
  bool away = false;
};

/// Objects that are kept beyond a folder.
struct KeptBeyond {
  KeptBeyond() {
    auto made = std::make_unique<MapStore>();
    store = made.get();
    objects.emplace(std::move(Objects::open(folder.path(), std::move(made)).value()));
  }
  TestFolder folder;
  MapStore* store = nullptr;
  std::optional<Objects> objects;
};

TEST(ObjectsBeyond, ArePutBeyondTheFolderAndFetchedOnce) {
  KeptBeyond world;
  ASSERT_EQ(world.objects->put(core::bytes_of("abc")).value(), kAbc);
  EXPECT_EQ(world.store->kept.at(kAbc), "abc");
  ASSERT_TRUE(world.objects->file(kAbc));
  EXPECT_EQ(world.store->reads, 0) << "it is in the folder still";
  std::filesystem::remove(world.objects->path_of(kAbc));
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(core::text_of(core::read_file(world.objects->file(kAbc).value()).value()), "abc");
  EXPECT_EQ(world.store->reads, 1);
  ASSERT_TRUE(world.objects->remove(kAbc));
  EXPECT_TRUE(world.store->kept.empty());
  EXPECT_EQ(files_in(world.folder.path() / "objects"), 0u);
}

TEST(ObjectsBeyond, AreNotAcknowledgedWhileTheStoreIsAwayAndAreWhenItIsBack) {
  KeptBeyond world;
  std::ofstream(world.folder.path() / "in") << "abc";
  world.store->away = true;
  EXPECT_FALSE(world.objects->put(core::bytes_of("abc")));
  EXPECT_FALSE(world.objects->copy_in(world.folder.path() / "in", kAbc));
  EXPECT_FALSE(world.objects->link_in(world.folder.path() / "in", kAbc));
  EXPECT_FALSE(world.objects->remove(kAbc));
  world.store->away = false;
  EXPECT_TRUE(world.objects->link_in(world.folder.path() / "in", kAbc))
      << "though it is in the folder";
  EXPECT_EQ(world.store->kept.at(kAbc), "abc");
}

TEST(ObjectsBeyond, ThatChangedThereAreNotHandedOut) {
  KeptBeyond world;
  world.store->kept[kAbc] = "abd";
  EXPECT_EQ(world.objects->file(kAbc).error().code, core::Errc::corrupt);
  EXPECT_EQ(files_in(world.folder.path() / "objects"), 0u);
  EXPECT_NE(world.objects->kept_sha256(kAbc).value(), kAbc);
}

TEST(ObjectsBeyond, AreCopiedBetweenFolderAndStoreBothWays) {
  KeptBeyond world;
  world.store->kept[kAbc] = "abc";
  const TestFolder other;
  const auto plain = std::move(Objects::open(other.path()).value());
  ASSERT_TRUE(plain.copy_from(*world.objects, kAbc));
  EXPECT_EQ(plain.kept_sha256(kAbc).value(), kAbc);
  EXPECT_EQ(files_in(world.folder.path() / "objects"), 0u) << "a backup does not fill the cache";
  world.store->kept.clear();
  ASSERT_TRUE(world.objects->copy_from(plain, kAbc));
  EXPECT_EQ(world.store->kept.at(kAbc), "abc");
}

TEST(ObjectsBeyond, TheCacheKeepsItsLimitAndWhatWasUsedWithinTheHour) {
  using namespace std::chrono_literals;
  KeptBeyond world;
  const std::string old = world.objects->put(core::bytes_of("old")).value();
  const std::string recent = world.objects->put(core::bytes_of("recent")).value();
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(world.objects->path_of(old), now - 2h);
  std::filesystem::last_write_time(world.objects->path_of(recent), now - 30min);
  world.objects->limit_cache(1);
  ASSERT_TRUE(world.objects->put(core::bytes_of("abc")));
  EXPECT_FALSE(std::filesystem::exists(world.objects->path_of(old)));
  EXPECT_TRUE(std::filesystem::exists(world.objects->path_of(recent)));
  EXPECT_EQ(world.store->kept.size(), 3u) << "what is kept stays";
  EXPECT_TRUE(world.objects->file(old)) << "and is fetched again";
}

TEST(Objects, InAFolderHaveNoCacheToLimit) {
  const TestFolder folder;
  auto objects = std::move(Objects::open(folder.path()).value());
  objects.limit_cache(0);
  ASSERT_TRUE(objects.put(core::bytes_of("abc")));
  std::filesystem::last_write_time(
      objects.path_of(kAbc), std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
  ASSERT_TRUE(objects.put(core::bytes_of("more")));
  EXPECT_TRUE(std::filesystem::exists(objects.path_of(kAbc)));
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
