/// Bounds from experts' and novices' scores.
#include "statistics/summary/cutoff.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus::statistics {
namespace {

Vector values_of(std::initializer_list<double> of) {
  return Eigen::Map<const Vector>(of.begin(), std::ssize(of));
}

TEST(Cutoff, MeanAndDeviations) {
  // By hand: 2, 4, 4, 4, 5, 5, 7, 9 have mean 5 and Σ(x − 5)² = 32, thus SD = √(32/7).
  const auto bound = mean_bound(values_of({2, 4, 4, 4, 5, 5, 7, 9}), 2.0);
  ASSERT_TRUE(bound);
  EXPECT_NEAR(*bound, 5.0 + 2.0 * std::sqrt(32.0 / 7.0), 1e-12);
  EXPECT_FALSE(mean_bound(values_of({1}), 2.0));
}

TEST(Cutoff, PercentilesAreThoseOfR) {
  // R 4.2: quantile(1:10, c(0, 0.1, 0.25, 0.9, 1)) is 1.0, 1.9, 3.25, 9.1, 10.0 (type 7).
  const Vector ten = values_of({10, 9, 8, 7, 6, 5, 4, 3, 2, 1});
  EXPECT_NEAR(*percentile(ten, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(*percentile(ten, 0.1), 1.9, 1e-12);
  EXPECT_NEAR(*percentile(ten, 0.25), 3.25, 1e-12);
  EXPECT_NEAR(*percentile(ten, 0.9), 9.1, 1e-12);
  EXPECT_NEAR(*percentile(ten, 1.0), 10.0, 1e-12);
  EXPECT_FALSE(percentile(Vector(), 0.5));
  EXPECT_FALSE(percentile(ten, 1.1));
}

TEST(Cutoff, YoudenByHand) {
  // Seconds; less is better. At 36.5, between 35 and 38: 3 of 4 experts pass, no novice does, J =
  // 0.75. At 42.5 all experts pass and 1 of 4 novices: J = 0.75 too, and 36.5 is the stricter. Of 16
  // pairs the expert is faster in 15 (40 against 38 is not): area 15/16.
  const auto cut =
      youden_cut(values_of({30, 32, 35, 40}), values_of({38, 45, 50, 60}), Passing::at_most);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->bound, 36.5, 1e-12);
  EXPECT_NEAR(cut->sensitivity, 0.75, 1e-12);
  EXPECT_NEAR(cut->specificity, 1.0, 1e-12);
  EXPECT_NEAR(cut->youden, 0.75, 1e-12);
  EXPECT_NEAR(cut->area, 15.0 / 16.0, 1e-12);
}

TEST(Cutoff, WhatShouldBeHighIsTheSameTurnedAround) {
  const auto cut = youden_cut(values_of({-30, -32, -35, -40}), values_of({-38, -45, -50, -60}),
                              Passing::at_least);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(cut->bound, -36.5, 1e-12);
  EXPECT_NEAR(cut->area, 15.0 / 16.0, 1e-12);
}

TEST(Cutoff, RefusesGroupsThatTellNothing) {
  EXPECT_FALSE(youden_cut(Vector(), values_of({1}), Passing::at_most));
  EXPECT_FALSE(youden_cut(values_of({1, 1}), values_of({1}), Passing::at_most));
}

}  // namespace
}  // namespace tractus::statistics
