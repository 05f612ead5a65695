#include "lab/signal/saturation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tractus::lab {
namespace {

constexpr double kNoiseOfWave = 0.01;

/// Slow waves of amplitude 1 with noise of 1 % (correlated over `kept`), cut off at ± `limit` and rounded to `step`.
std::vector<double> wave(double step, double limit, double noise = kNoiseOfWave,
                         double kept = 0.0) {
  std::mt19937_64 random(4);
  std::normal_distribution<> normal;
  std::vector<double> out;
  double error = 0.0;
  for (int k = 0; k < 6000; ++k) {
    error = kept * error + std::sqrt(1.0 - kept * kept) * noise * normal(random);
    const double value = std::clamp(std::sin(k / 160.0) + error, -limit, limit);
    out.push_back(step > 0.0 ? step * std::round(value / step) : value);
  }
  return out;
}

SensorRange range_of(const std::vector<double>& y) {
  const std::span<const double> one(y);
  return sensor_range({&one, 1});
}

TEST(Saturation, IsSeenAtBothEndsWhetherTheEndIsAStepOrNot) {
  for (const double step : {0.0, 0.005, 0.01})
    for (const double limit : {0.9, 0.9013, 0.97}) {
      const auto y = wave(step, limit);
      const auto [least, most] = std::ranges::minmax(y);
      const SensorRange range = range_of(y);
      EXPECT_EQ(range.least, least) << step << " " << limit;
      EXPECT_EQ(range.most, most) << step << " " << limit;
      EXPECT_TRUE(range.ends_at(most));
      EXPECT_FALSE(range.ends_at(0.5));
    }
}

/// A share of 0.1 % is eight samples among 8000: no recording alone has a long run of them.
TEST(Saturation, IsSeenInFewSamplesOfManyRecordings) {
  std::mt19937_64 random(9);
  std::normal_distribution<> normal;
  std::vector<std::vector<double>> recordings(10);
  std::size_t cut = 0;
  for (auto& y : recordings)
    for (int k = 0; k < 8000; ++k) {
      const double value = 0.8 * normal(random);
      cut += value > 2.4 ? 1 : 0;
      y.push_back(std::min(0.01 * std::round(value / 0.01), 2.4));
    }
  ASSERT_LT(double(cut), 0.002 * 80000);
  const std::vector<std::span<const double>> views(recordings.begin(), recordings.end());
  EXPECT_EQ(sensor_range(views).most, 2.4);
  EXPECT_FALSE(sensor_range(views).least);
}

TEST(Saturation, IsNotSeenInAChannelThatStaysWithinItsRange) {
  for (const double step : {0.0, 0.005, 0.01, 0.03})
    for (const double kept : {0.0, 0.9, 0.98}) {
      const SensorRange range = range_of(wave(step, 9.0, kNoiseOfWave, kept));
      EXPECT_FALSE(range.least || range.most) << step << " " << kept;
    }
}

/// Rounded so coarsely that the noise is lost, a wave stays at its largest value by itself.
TEST(Saturation, IsNotSeenWhereRoundingHidesTheNoise) {
  for (const double step : {0.02, 0.05, 0.1})
    for (const double noise : {0.0, 0.003, kNoiseOfWave}) {
      const SensorRange range = range_of(wave(step, 9.0, noise));
      EXPECT_FALSE(range.least || range.most) << step << " " << noise;
    }
}

TEST(Saturation, NeedsNoiseThatShows) {
  std::vector<double> y(4000, 1.0);  // a force that rises and is held
  for (std::size_t k = 0; k < 2000; ++k) y[k] = double(k) / 2000.0;
  EXPECT_FALSE(shows_noise(y, 1e-9));
  EXPECT_TRUE(shows_noise(wave(0.0, 9.0), kNoiseOfWave));
}

TEST(Saturation, IsNotSeenInSamplesOfFewValues) {
  const std::vector<double> held(4000, 1.0);
  const SensorRange range = range_of(held);
  EXPECT_FALSE(range.least || range.most);
}

}  // namespace
}  // namespace tractus::lab
