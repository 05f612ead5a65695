#include "lab/compare/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tractus {
namespace lab {
namespace {

/// Two trials of four samples; by hand: residuals 1, −1, 1, −1 and 2, 2, −2, −2.
Samples eight() {
  Samples samples;
  samples.channels = {{"fz_N", 0.5}};
  samples.judged = {0};
  samples.judged_name = "fz_N";
  samples.features = {{"phase", "", {"hold", "advance"}}};
  TrialSamples a{"a", {0, 1, 2, 3}, {{1, 3, 5, 7}}, {{0, 4, 4, 8}}, 1, {{0, 0, 1, 1}}};
  TrialSamples b{"b", {0, 1, 2, 3}, {{1, 3, 5, 7}}, {{-1, 1, 7, 9}}, 1, {{0, 1, 1, 1}}};
  samples.trials = {a, b};
  return samples;
}

TEST(Comparison, CountsTheJudgedSamplesAlone) {
  // By hand: the last two of the second trial left out, residuals 1, −1, 1, −1 and 2, 2 remain.
  Samples samples = eight();
  samples.trials[1].judgement = {Judgement::judged, Judgement::judged, Judgement::at_border,
                                 Judgement::at_border};
  const Comparison c = compare(samples);
  EXPECT_NEAR(c.rmse, std::sqrt(12.0 / 6.0), 1e-12);
  EXPECT_NEAR(c.trials[1].rmse, 2.0, 1e-12);
  ASSERT_EQ(c.judgements.size(), 2u);
  EXPECT_NEAR(c.judgements[0].share, 6.0 / 8.0, 1e-12);
  EXPECT_EQ(c.judgements[1].judgement, Judgement::at_border);
  ASSERT_EQ(c.phases.size(), 2u);
  EXPECT_NEAR(c.phases[1].rmse, std::sqrt((1.0 + 1.0 + 4.0) / 3.0), 1e-12);
  EXPECT_NEAR(c.phases[1].judged_share, 3.0 / 5.0, 1e-12);
}

TEST(Comparison, MatchesAHandCalculation) {
  const Comparison out = compare(eight());
  ASSERT_EQ(out.channels.size(), 1u);
  // Squares: 4 · 1 + 4 · 4 = 20 over 8. Variance of 1, 3, 5, 7: mean 4, (9 + 1 + 1 + 9) / 4 = 5.
  EXPECT_NEAR(out.channels[0].rmse, std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(out.channels[0].r2, 1.0 - 2.5 / 5.0, 1e-12);
  EXPECT_NEAR(out.channels[0].explained, (5.0 - 2.5) / (5.0 - 0.25), 1e-12);
  EXPECT_NEAR(out.channels[0].bias, 0.0, 1e-12);
  EXPECT_NEAR(out.trials[0].rmse, 1.0, 1e-12);
  EXPECT_NEAR(out.trials[1].rmse, 2.0, 1e-12);
  EXPECT_NEAR(out.rmse, std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(out.channels[0].measured.p50, 4.0, 1e-12);
  // Hold: samples 0, 1 of a and 0 of b: 1 + 1 + 4 of 20 in 3 of 8.
  ASSERT_EQ(out.phases.size(), 2u);
  EXPECT_NEAR(out.phases[0].share_of_error, 0.3, 1e-12);
  EXPECT_NEAR(out.phases[0].share_of_time, 0.375, 1e-12);
  EXPECT_NEAR(out.phases[0].rmse, std::sqrt(2.0), 1e-12);
}

/// What is left holds the noise.
TEST(Comparison, StatesNoFloorAboveWhatIsLeft) {
  Samples samples = eight();
  samples.channels[0].noise_floor = 0.0;
  const Comparison sure = compare(samples);
  samples.channels[0].noise_floor = 1.5 * sure.rmse;
  const Comparison unsure = compare(samples);
  EXPECT_DOUBLE_EQ(unsure.channels[0].noise_floor, sure.rmse);
  EXPECT_DOUBLE_EQ(unsure.noise_floor, sure.rmse);
}

TEST(Comparison, CannotExplainWhatIsNoiseAlone) {
  Samples samples = eight();
  samples.channels[0].noise_floor = std::sqrt(5.0);
  EXPECT_TRUE(std::isnan(compare(samples).channels[0].explained));
}

// A sine of amplitude A has the power A²/2, all of it in the band that holds its frequency.
TEST(Comparison, SpectrumHoldsTheSinesPowerWhereItsFrequencyIs) {
  Samples samples;
  samples.channels = {{"fz_N", 0.0}};
  samples.judged = {0};
  TrialSamples trial;
  trial.id = "sine";
  trial.measured.resize(1);
  trial.simulated.resize(1);
  for (int k = 0; k < 16384; ++k) {
    trial.t_s.push_back(k / 1024.0);
    trial.measured[0].push_back(3.0 * std::sin(2.0 * std::numbers::pi * 100.0 * k / 1024.0));
    trial.simulated[0].push_back(0.0);
  }
  samples.trials = {trial};
  const Spectrum spectrum = compare(samples).channels[0].spectrum;
  std::size_t peak = 0;
  for (std::size_t k = 0; k < spectrum.residual.size(); ++k)
    if (spectrum.residual[k] > spectrum.residual[peak]) peak = k;
  EXPECT_NEAR(spectrum.frequency_Hz[peak], 100.0, 13.0);  // half a third of an octave
  // The band about it is a third of an octave of 0.5 Hz lines wide.
  const double width = (spectrum.frequency_Hz[peak + 1] - spectrum.frequency_Hz[peak - 1]) / 2.0;
  EXPECT_NEAR(spectrum.residual[peak] * width, 4.5, 0.45);
  EXPECT_LT(spectrum.residual[peak - 3], 1e-6 * spectrum.residual[peak]);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
