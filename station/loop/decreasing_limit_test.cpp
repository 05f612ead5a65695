#include "station/loop/decreasing_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace loop {
namespace {

TEST(DecreasingLimit, OnlyFalls) {
  DecreasingLimit limit;
  EXPECT_TRUE(std::isinf(limit.value()));
  for (const auto& [asked, holds] : {std::pair(5.0, 5.0),
                                     {7.0, 5.0},
                                     {2.0, 2.0},
                                     {-1.0, 2.0},
                                     {std::nan(""), 2.0},
                                     {0.0, 0.0},
                                     {1.0, 0.0}}) {
    limit.lower(asked);
    EXPECT_EQ(limit.value(), holds) << asked;
  }
  const DecreasingLimit copy = limit;
  EXPECT_EQ(copy.value(), 0.0);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
