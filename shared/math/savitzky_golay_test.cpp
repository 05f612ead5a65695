#include "math/savitzky_golay.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace math {
namespace {

TEST(SavitzkyGolay, HasTheKnownWeightsOfFivePoints) {
  // Exact rationals for 5 points, order 2 (tests/golden/statistics/motion_metrics.json): smoothing
  // (-3 12 17 12 -3)/35, slope (-2 -1 0 1 2)/10.
  const double smooth[] = {-3 / 35., 12 / 35., 17 / 35., 12 / 35., -3 / 35.};
  const double slope[] = {-.2, -.1, 0., .1, .2};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(SavitzkyGolay(5, 2, 0).weights(2)[i], smooth[i], 1e-14);
    EXPECT_NEAR(SavitzkyGolay(5, 2, 1).weights(2)[i], slope[i], 1e-14);
  }
}

TEST(SavitzkyGolay, IsExactForACubicUpToTheEnds) {
  // y = t³ - 2t: y' = 3t² - 2, y'' = 6t.
  const double dt = 0.01;
  std::vector<double> y;
  for (int i = 0; i < 30; ++i) y.push_back(std::pow(i * dt, 3) - 2 * i * dt);
  const auto first = SavitzkyGolay(21, 3, 1).apply(y, dt);
  const auto second = SavitzkyGolay(7, 3, 2).apply(y, dt);
  for (int i = 0; i < 30; ++i) {
    EXPECT_NEAR(first[std::size_t(i)], 3 * std::pow(i * dt, 2) - 2, 1e-11) << i;
    EXPECT_NEAR(second[std::size_t(i)], 6 * i * dt, 1e-9) << i;
  }
}

TEST(SavitzkyGolay, GivesNothingForLessThanAWindow) {
  EXPECT_TRUE(SavitzkyGolay(21, 3, 1).apply(std::vector<double>(20, 1.0), 1.0).empty());
}

}  // namespace
}  // namespace math
}  // namespace tractus
