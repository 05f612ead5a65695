#include "lab/signal/saturation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace tractus::lab {
namespace {

constexpr double kNoise = 0.01;

/// A slow wave of amplitude 1 with noise, rounded to `step`, cut off at ± `limit`.
std::vector<double> wave(double step, double limit, double noise = kNoise) {
  std::mt19937_64 random(4);
  std::normal_distribution<> normal;
  std::vector<double> out;
  for (int k = 0; k < 6000; ++k) {
    const double value = std::sin(k / 160.0) + noise * normal(random);
    out.push_back(std::clamp(step > 0.0 ? step * std::round(value / step) : value, -limit, limit));
  }
  return out;
}

std::ptrdiff_t count(const std::vector<char>& of) { return std::ranges::count(of, 1); }

TEST(Saturation, IsSeenAtBothEndsWhetherTheEndIsAStepOrNot) {
  for (const double step : {0.0, 0.005, 0.01})
    for (const double limit : {0.9, 0.9013}) {
      const auto y = wave(step, limit);
      const auto cut = std::ranges::count_if(y, [&](double v) { return std::abs(v) == limit; });
      const auto found = saturated(y, kNoise);
      EXPECT_GT(double(count(found)), 0.8 * double(cut)) << step << " " << limit;
      for (std::size_t k = 0; k < y.size(); ++k)
        EXPECT_TRUE(!found[k] || std::abs(y[k]) == limit) << k;
    }
}

TEST(Saturation, IsNotSeenInAChannelThatStaysWithinItsRange) {
  for (const double step : {0.0, 0.005, 0.01, 0.03})
    EXPECT_EQ(count(saturated(wave(step, 9.0), kNoise)), 0);
}

/// Rounded so coarsely that the noise is lost, a wave stays at its largest value by itself.
TEST(Saturation, IsNotSeenWhereRoundingHidesTheNoise) {
  EXPECT_EQ(count(saturated(wave(0.1, 9.0), 0.1 / std::sqrt(12.0))), 0);
}

TEST(Saturation, IsNotSeenInAHoldWithoutNoise) {
  std::vector<double> y(4000, 1.0);
  for (std::size_t k = 0; k < 2000; ++k) y[k] = double(k) / 2000.0;
  EXPECT_EQ(count(saturated(y, 1e-9)), 0);
}

}  // namespace
}  // namespace tractus::lab
