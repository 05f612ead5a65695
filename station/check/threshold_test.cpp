#include "station/check/threshold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "station/check/simulated_person.hpp"

namespace tractus {
namespace check {
namespace {

constexpr int kQuestions = 35;

core::Result<MeasuredThreshold> measured_of(SimulatedPerson& person, Stimulus stimulus,
                                            std::uint64_t seed) {
  core::ManualClock clock;
  const loop::HandLimits limits;
  loop::Limiter limiter(limits, 1'000'000);
  return measure_threshold({clock, clock, person, limiter, 1000.0}, stimulus, kQuestions, seed,
                           person.asked());
}

TEST(SimulatedPerson, HasTheThresholdsOfTwoNoisyLooks) {
  // By hand, with t = 30 mN and no share of the force: √2 · 0.67449 · 0.03 = 0.028616.
  SimulatedPerson person({.force_threshold_N = 0.03, .force_weber = 0.0}, 1);
  EXPECT_NEAR(person.threshold(Stimulus::detection), 0.028616, 1e-5);
  EXPECT_NEAR(person.threshold(Stimulus::difference), 0.028616, 1e-5);
  EXPECT_NEAR(person.threshold(Stimulus::gap), 0.028616 / 200.0, 1e-7);
}

TEST(Threshold, OfKnownPeopleLiesWithinItsIntervalAsOftenAsItSays) {
  // 95 % of 60 are 57; 51 or fewer would come by chance once in 100 (binomial, by hand).
  for (const Stimulus stimulus : core::values<Stimulus>()) {
    int within = 0, of = 0;
    for (const double worse : {0.7, 1.0, 2.0})
      for (std::uint64_t seed = 1; seed <= 20; ++seed, ++of) {
        SimulatedPerson person({.force_threshold_N = 0.030 * worse, .force_weber = 0.07 * worse},
                               seed);
        const auto found = measured_of(person, stimulus, 1000 + seed);
        ASSERT_TRUE(found) << found.error().what;
        const double truth = person.threshold(stimulus);
        const auto& range = found->threshold.interval_95;
        within += range.low <= truth && truth <= range.high;
      }
    RecordProperty(std::string("within_of_60_") + std::string(name(stimulus)), within);
    EXPECT_GE(within, 52) << name(stimulus) << ", of " << of;
  }
}

TEST(Threshold, EndsWithoutForceAndSaysWhenNobodyAnswers) {
  SimulatedPerson person({}, 1);
  core::ManualClock clock;
  const loop::HandLimits limits;
  loop::Limiter limiter(limits, 250'000);
  const auto silent =
      measure_threshold({clock, clock, person, limiter}, Stimulus::detection, 5, 1,
                        {.begins = [](Stimulus, Moment) {}, .answer = [] { return 0; }});
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, core::Errc::unavailable);
  EXPECT_EQ(limiter.guard(), loop::Guard::off);
}

TEST(Threshold, StopsWhenItIsAskedTo) {
  SimulatedPerson person({}, 1);
  core::ManualClock clock;
  const loop::HandLimits limits;
  loop::Limiter limiter(limits, 250'000);
  const auto stopped =
      measure_threshold({clock, clock, person, limiter, 4000.0, [](double) { return false; }},
                        Stimulus::gap, 5, 1, person.asked());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::cancelled);
}

TEST(ObserverRecord, TakesTheDetectionOutOfTheDifference) {
  // By hand: t = 0.03 N, J = 0.05 N at 1 N, w = √(0.05² − 0.03²) = 0.04.
  ObserverRecord record{.who = "Ada"};
  record.measured = {{.stimulus = Stimulus::detection, .threshold = {0.03, {0.02, 0.04}, 1.0}},
                     {.stimulus = Stimulus::difference, .threshold = {0.05, {0.04, 0.06}, 1.0}}};
  const auto json = record.to_json();
  EXPECT_NEAR(json["perception"]["force_threshold_N"].get<double>(), 0.03, 1e-12);
  EXPECT_NEAR(json["perception"]["force_weber"].get<double>(), 0.04, 1e-12);
  EXPECT_NEAR(json["thresholds"]["difference"]["high_N"].get<double>(), 0.06, 1e-12);
}

}  // namespace
}  // namespace check
}  // namespace tractus
