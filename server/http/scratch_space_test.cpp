#include "server/http/scratch_space.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace tractus {
namespace http {
namespace {

// Limits of 100 bytes for one, 250 in all: the numbers below are theirs.
class Scratch : public ::testing::Test {
 protected:
  bool takes(const std::string& client, std::uint64_t bytes) {
    auto share = space_.reserve(client, bytes);
    if (share) held_.push_back(std::move(*share));
    return bool(share);
  }
  ScratchSpace space_{::testing::TempDir(), {.per_client = 100, .in_all = 250}};
  std::vector<ScratchSpace::Share> held_;
};

TEST_F(Scratch, OneClientHasNoMoreThanItsLimit) {
  EXPECT_TRUE(takes("a", 60));
  EXPECT_TRUE(takes("a", 40));
  EXPECT_FALSE(takes("a", 1));
  EXPECT_TRUE(takes("b", 100));
}

TEST_F(Scratch, AllTogetherHaveNoMoreThanTheirs) {
  EXPECT_TRUE(takes("a", 100));
  EXPECT_TRUE(takes("b", 100));
  EXPECT_FALSE(takes("c", 51));
  EXPECT_TRUE(takes("c", 50));
}

TEST_F(Scratch, WhatIsOverCanBeHadAgain) {
  EXPECT_TRUE(takes("a", 100));
  EXPECT_TRUE(takes("b", 100));
  held_.clear();
  EXPECT_TRUE(takes("a", 100));
  EXPECT_TRUE(takes("b", 100));
  EXPECT_TRUE(takes("c", 50));
}

TEST_F(Scratch, WhatIsNotNeededIsGivenBackEarly) {
  auto share = space_.reserve("a", 100);
  ASSERT_TRUE(share);
  share->shrink_to(30);
  EXPECT_TRUE(takes("a", 70));
  EXPECT_FALSE(takes("a", 1));
  share->shrink_to(0);
  EXPECT_TRUE(takes("a", 30));
}

TEST_F(Scratch, ANumberThatOverflowsIsRefused) {
  EXPECT_TRUE(takes("a", 10));
  EXPECT_FALSE(takes("a", UINT64_MAX));
  EXPECT_FALSE(takes("a", UINT64_MAX - 5));
}

TEST_F(Scratch, TheRefusalSaysWhoseLimitItIs) {
  EXPECT_TRUE(takes("a", 100));
  const auto own = space_.reserve("a", 1);
  ASSERT_FALSE(own);
  EXPECT_EQ(own.error().code, core::Errc::unavailable);
  EXPECT_NE(own.error().what.find("your transfers"), std::string::npos);
  EXPECT_TRUE(takes("b", 100));
  const auto all = space_.reserve("c", 100);
  ASSERT_FALSE(all);
  EXPECT_NE(all.error().what.find("all transfers"), std::string::npos);
}

TEST_F(Scratch, AFileGoesWithItsShare) {
  std::filesystem::path path;
  {
    const auto file = scratch_file(space_, "a", 100);
    ASSERT_TRUE(file);
    path = (*file)->path;
    std::ofstream(path) << "bytes";
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_FALSE(takes("a", 1));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(takes("a", 100));
}

}  // namespace
}  // namespace http
}  // namespace tractus
