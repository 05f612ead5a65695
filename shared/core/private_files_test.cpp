#include <gtest/gtest.h>

#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"

namespace tractus {
namespace core {
namespace {
namespace fs = std::filesystem;

/// A tree that everybody may read: a folder "objects", a program, a link that leads out of it.
class OpenTree : public ::testing::Test {
 protected:
  OpenTree() {
    fs::create_directories(root_ / "objects" / "ab");
    for (const fs::path& file :
         {root_ / "key", root_ / "program", root_ / "objects" / "ab" / "cd", fs::path(outside_)})
      std::ofstream(file) << "text";
    fs::create_symlink(outside_, root_ / "link");
    for (const auto& entry : fs::recursive_directory_iterator(root_))
      if (!entry.is_symlink()) fs::permissions(entry.path(), fs::perms(0755));
    for (const fs::path& file : {root_ / "key", fs::path(outside_)})
      fs::permissions(file, fs::perms(0644));
    fs::permissions(root_, fs::perms(0755));
  }
  ~OpenTree() override {
    fs::remove_all(root_);
    fs::remove(outside_);
  }
  static unsigned mode(const fs::path& path) {
    return static_cast<unsigned>(fs::status(path).permissions());
  }
  const fs::path root_ = fs::path(::testing::TempDir()) / ("tractus-" + new_id());
  const std::string outside_ = root_.string() + "-outside";
};

TEST_F(OpenTree, IsItsOwnersAloneAfterwards) {
  const auto repaired = make_private(root_);
  ASSERT_TRUE(repaired) << repaired.error().what;
  EXPECT_EQ(*repaired, 6u);
  EXPECT_EQ(mode(root_), 0700u);
  EXPECT_EQ(mode(root_ / "key"), 0600u);
  EXPECT_EQ(mode(root_ / "program"), 0700u);
  EXPECT_EQ(mode(root_ / "objects" / "ab" / "cd"), 0700u);
  EXPECT_EQ(mode(outside_), 0644u) << "a link was followed";
  EXPECT_EQ(make_private(root_).value(), 0u);
}

TEST_F(OpenTree, AFolderThatWasPrivateAlreadyIsNotEntered) {
  fs::permissions(root_ / "objects", fs::perms(0700));
  EXPECT_EQ(make_private(root_, "objects").value(), 3u) << "root, key, program";
  EXPECT_EQ(mode(root_ / "objects" / "ab"), 0755u);
  fs::permissions(root_ / "objects", fs::perms(0750));
  EXPECT_EQ(make_private(root_, "objects").value(), 3u) << "objects, ab, cd";
}

TEST_F(OpenTree, ALinkToTheFolderIsTheFolder) {
  const fs::path link = root_.string() + "-link";
  fs::create_directory_symlink(root_, link);
  EXPECT_EQ(make_private(link).value(), 6u);
  fs::remove(link);
}

TEST(PrivateScratch, IsItsOwnersAloneUntilItIsKept) {
  const fs::path target = fs::path(::testing::TempDir()) / ("tractus-kept-" + new_id());
  auto scratch = ScratchFolder::make(target);
  ASSERT_TRUE(scratch);
  EXPECT_EQ(fs::status(scratch->path()).permissions(), fs::perms::owner_all);
  const fs::path usual = scratch->path() / "usual";
  fs::create_directory(usual);
  const auto mode = fs::status(usual).permissions();
  ASSERT_TRUE(scratch->keep_as(target));
  EXPECT_EQ(fs::status(target).permissions(), mode) << "as any new folder";
  fs::remove_all(target);
}

}  // namespace
}  // namespace core
}  // namespace tractus
