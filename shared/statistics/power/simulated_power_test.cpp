/// Power by simulation against closed forms, within the Monte Carlo error: the noncentral t of
/// power.t.test (R 4.2.2) and of designs whose mixed model's test is a t test.
#include "statistics/power/simulated_power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/mixed_model.hpp"

namespace tractus {
namespace statistics {
namespace {

using Compares = StudyDesign::Compares;

double power_of_t(double delta, double df) {
  const double critical = student_t_quantile(0.975, df);
  return noncentral_t_upper(critical, df, delta) + noncentral_t_cdf(-critical, df, delta);
}

/// Five standard errors of the share: once in two million seeds.
void expect_power(const StudyDesign& design, double want, int runs) {
  const auto got = simulated_power(design, runs, 1);
  ASSERT_TRUE(got) << got.error().what;
  EXPECT_EQ(got->failed, 0);
  EXPECT_NEAR(got->power, want, 5.0 * std::sqrt(want * (1.0 - want) / runs));
  EXPECT_LE(got->interval.low, got->power);
  EXPECT_GE(got->interval.high, got->power);
}

TEST(SimulatedPowerTest, TwoGroupsOfOneTrialHaveThePowerOfTheTTest) {
  // power.t.test(n = 17, delta = 1)$power = 0.8070359; (n = 20, delta = 0.5) = 0.3377084
  StudyDesign design{.compares = Compares::groups, .surgeons = 17, .trials = 1, .effect = 1.0};
  expect_power(design, 0.8070359, 4000);
  design.surgeons = 20;
  design.effect = 0.5;
  expect_power(design, 0.3377084, 4000);
}

TEST(SimulatedPowerTest, NoEffectIsFoundAsOftenAsAlphaSays) {
  const StudyDesign design{.compares = Compares::groups, .surgeons = 8, .trials = 1};
  expect_power(design, 0.05, 4000);
}

TEST(SimulatedPowerTest, GroupsOfRepeatedTrialsHaveThePowerOfTheirMeans) {
  // Balanced: the mixed model's test is the t test of surgeons' means, of variance τ² + σ²/T.
  const StudyDesign design{.compares = Compares::groups,
                           .surgeons = 9,
                           .trials = 4,
                           .effect = 1.5,
                           .surgeon_sd = 1.0,
                           .residual_sd = 0.8};
  const double sd = std::sqrt(1.0 + 0.64 / 4.0);
  expect_power(design, power_of_t(1.5 / (sd * std::sqrt(2.0 / 9.0)), 16.0), 1000);
}

TEST(SimulatedPowerTest, ATrendOverTrialsHasThePowerOfTheWithinSurgeonRegression) {
  // Balanced with a random intercept: b on nT − n − 1 df, of variance σ²/(n Σ(t − t̄)²).
  StudyDesign design{.compares = Compares::trials,
                     .surgeons = 6,
                     .trials = 5,
                     .effect = 0.25,
                     .surgeon_sd = 1.5,
                     .residual_sd = 0.7};
  const double want = power_of_t(0.25 * std::sqrt(6.0 * 10.0) / 0.7, 6.0 * 5.0 - 6.0 - 1.0);
  expect_power(design, want, 1000);
  design.df = SmallSample::kenward_roger;
  expect_power(design, want, 1000);
}

TEST(SimulatedPowerTest, VaryingSlopesHaveThePowerOfATTestOfSlopes) {
  // Balanced with random slopes: the t test of surgeons' own slopes, of variance τ_s² + σ²/Σ(t − t̄)².
  const StudyDesign design{.compares = Compares::trials,
                           .surgeons = 8,
                           .trials = 6,
                           .effect = 0.5,
                           .surgeon_sd = 1.0,
                           .slope_sd = 0.4,
                           .residual_sd = 0.5};
  const double sd = std::sqrt(0.16 + 0.25 / 17.5);
  expect_power(design, power_of_t(0.5 * std::sqrt(8.0) / sd, 7.0), 1000);
}

TEST(SimulatedPowerTest, CrossedScenariosLeaveTheComparisonOfConditions) {
  // Each surgeon meets both conditions of each scenario equally often, so that surgeons and
  // scenarios drop out: difference of variance 4σ²/nT, on nT − n − (S − 1) − 1 df.
  const StudyDesign design{.compares = Compares::conditions,
                           .surgeons = 6,
                           .trials = 8,
                           .scenarios = 4,
                           .effect = 0.7,
                           .surgeon_sd = 1.0,
                           .scenario_sd = 0.8,
                           .residual_sd = 0.9};
  const double delta = 0.7 * std::sqrt(48.0) / (2.0 * 0.9);
  expect_power(design, power_of_t(delta, 48.0 - 6.0 - 3.0 - 1.0), 1000);
}

TEST(SimulatedPowerTest, FindsTheSmallestNumberOfSurgeons) {
  // power.t.test(delta = 1, power = 0.9)$n = 22.02110: 23; 22 reaches 0.8997.
  const StudyDesign design{.compares = Compares::groups, .trials = 1, .effect = 1.0};
  const auto got = needed_surgeons(design, 0.9, 4000, 1);
  ASSERT_TRUE(got) << got.error().what;
  EXPECT_GE(got->power, 0.9);
  EXPECT_EQ(got->runs, 4000);
  EXPECT_NEAR(got->surgeons, 22.5, 1.5);
}

TEST(SimulatedPowerTest, TheSameSeedGivesTheSameAnswer) {
  const StudyDesign design{.surgeons = 4, .trials = 3, .effect = 0.5, .surgeon_sd = 1.0};
  const auto a = simulated_power(design, 200, 7), b = simulated_power(design, 200, 7),
             c = simulated_power(design, 200, 8);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->significant, b->significant);
  EXPECT_NE(a->significant, c->significant);
}

TEST(SimulatedPowerTest, RefusesWhatCannotBeAnalysed) {
  const auto why = [](const StudyDesign& design) {
    const auto got = simulated_power(design, 10, 1);
    return got ? "" : got.error().what;
  };
  EXPECT_EQ(why({.surgeons = 1}), "power: at least 2 surgeons are needed");
  EXPECT_EQ(why({.trials = 1}), "power: a comparison within surgeons needs 2 trials of each");
  EXPECT_EQ(why({.trials = 2, .slope_sd = 1.0}),
            "power: slopes that vary between surgeons need 3 trials of each");
  EXPECT_EQ(why({.trials = 2, .scenarios = 3}),
            "power: each surgeon needs a trial of each scenario at least");
  const auto none = needed_surgeons({.compares = Compares::groups, .trials = 1}, 0.8, 100, 1);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, core::Errc::out_of_range);
}

TEST(SimulatedPowerTest, IsStoppedWhenAsked) {
  int calls = 0;
  const auto got = simulated_power({.effect = 1.0}, 1000, 1, [&](double) { return ++calls < 3; });
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, core::Errc::cancelled);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
