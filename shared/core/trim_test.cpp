#include "core/trim.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace core {
namespace {

TEST(Trimmed, TakesBlanksFromBothEndsAlone) {
  EXPECT_EQ(trimmed(" \t a b\t "), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \t "), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("a\n"), "a\n") << "a line's end is no blank";
}

TEST(Trimmed, TakesOtherCharactersWhereTheyAreNamed) {
  EXPECT_EQ(trimmed(std::string_view("CT \0", 4), std::string_view(" \0", 2)), "CT");
}

}  // namespace
}  // namespace core
}  // namespace tractus
