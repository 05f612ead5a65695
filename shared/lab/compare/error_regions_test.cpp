#include "lab/compare/error_regions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lab/compare/comparison.hpp"

namespace tractus {
namespace lab {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// In and out of a hole 30 mm deep as a triangle of 4 s, 12 s at 100 Hz; the residual is noise of
/// 0.1 N and whatever `add` says.
Samples made(std::size_t trials, const std::function<double(double depth_m, bool out)>& add) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  Samples samples;
  samples.channels = {{"fz_N", 0.1}};
  samples.judged = {0};
  samples.judged_name = "fz_N";
  samples.judged_unit = "N";
  samples.features = {
      {"depth", "m", {}}, {"direction", "", {"in", "out", "still"}}, {"rotation", "rad/s", {}}};
  for (std::size_t t = 0; t < trials; ++t) {
    TrialSamples trial;
    trial.id = "trial" + std::to_string(t + 1);
    trial.measured.resize(1);
    trial.simulated.resize(1);
    trial.features.resize(3);
    for (int k = 0; k < 1200; ++k) {
      const double phase = std::fmod(0.01 * k, 4.0) / 4.0;
      const bool out = phase >= 0.5;
      const double depth = 0.06 * (out ? 1.0 - phase : phase);
      trial.t_s.push_back(0.01 * k);
      trial.simulated[0].push_back(10.0 * depth);
      trial.measured[0].push_back(10.0 * depth + noise(random) + add(depth, out));
      trial.features[0].push_back(float(depth));
      trial.features[1].push_back(out ? 1.0f : 0.0f);
      trial.features[2].push_back(float(noise(random)));
    }
    samples.trials.push_back(trial);
  }
  return samples;
}

double deep_out(double depth_m, bool out) { return out && depth_m > 0.02 ? -2.0 : 0.0; }

// 2 N in one sixth of the time: a mean square of 4/6 against noise of 0.01, so 0.67 of 0.677.
TEST(ErrorRegions, FindsTheRegionThatWasMadeWrong) {
  const ErrorRegions found = find_error_regions(made(10, deep_out));
  ASSERT_FALSE(found.regions.empty());
  const Region& first = found.regions.front();
  EXPECT_EQ(first.text, "direction = out and depth > 0.02 m");
  EXPECT_EQ(first.words, "direction = out and depth > 20 mm");
  EXPECT_NEAR(first.share_of_error, (4.01 / 6.0) / (4.0 / 6.0 + 0.01), 0.01);
  EXPECT_NEAR(first.share_of_time, 1.0 / 6.0, 0.005);
  EXPECT_NEAR(first.rmse, std::sqrt(4.01), 0.02);
  ASSERT_THAT(first.mean, SizeIs(1));
  EXPECT_NEAR(first.mean[0], -2.0, 0.03);
}

TEST(ErrorRegions, FindsTheSameRegionInASingleTrial) {
  const ErrorRegions found = find_error_regions(made(1, deep_out));
  ASSERT_FALSE(found.regions.empty());
  EXPECT_EQ(found.regions.front().text, "direction = out and depth > 0.02 m");
  EXPECT_THAT(found.honest, HasSubstr("one trial"));
}

TEST(ErrorRegions, SaysEverywhereWhenNothingStandsOut) {
  const ErrorRegions found = find_error_regions(made(10, [](double, bool) { return 0.0; }));
  ASSERT_THAT(found.regions, SizeIs(1));
  EXPECT_EQ(found.regions[0].text, "everywhere");
  EXPECT_NEAR(found.regions[0].share_of_error, 1.0, 1e-12);
  EXPECT_NEAR(found.regions[0].share_of_time, 1.0, 1e-12);
}

// +1 N going in, −1 N coming out: equally wrong in both, yet with another sign in each.
TEST(ErrorRegions, SeparatesErrorsOfOppositeSign) {
  const ErrorRegions found =
      find_error_regions(made(10, [](double, bool out) { return out ? -1.0 : 1.0; }));
  ASSERT_THAT(found.regions, SizeIs(2));
  for (const Region& region : found.regions)
    EXPECT_NEAR(region.mean[0], region.text == "direction = out" ? -1.0 : 1.0, 0.03) << region.text;
}

// An error in one trial alone is no region of the model's.
TEST(ErrorRegions, LeavesOutWhatOnlyOneTrialShows) {
  Samples samples = made(8, [](double, bool) { return 0.0; });
  for (std::size_t k = 0; k < 1200; ++k)
    if (samples.trials[2].features[0][k] > 0.02f) samples.trials[2].measured[0][k] += 3.0;
  const ErrorRegions found = find_error_regions(samples);
  ASSERT_THAT(found.regions, SizeIs(1));
  EXPECT_EQ(found.regions[0].text, "everywhere");
}

// Slow and fast in each direction: no region names its direction twice.
TEST(ErrorRegions, SaysEachConditionOnce) {
  const ErrorRegions found = find_error_regions(made(
      10, [](double depth, bool out) { return (out ? 1.0 : -1.0) * (depth > 0.02 ? 2.0 : 0.4); }));
  for (const Region& region : found.regions) {
    const auto first = region.text.find("direction");
    EXPECT_EQ(region.text.find("direction", first + 1), std::string::npos) << region.text;
  }
}

TEST(ErrorRegions, BoundsFromBothSidesStandTogether) {
  const ErrorRegions found = find_error_regions(
      made(10, [](double depth, bool) { return depth > 0.01 && depth < 0.015 ? 2.0 : 0.0; }));
  ASSERT_FALSE(found.regions.empty());
  EXPECT_EQ(found.regions.front().text, "depth > 0.01 m and depth < 0.015 m");
}

}  // namespace
}  // namespace lab
}  // namespace tractus
