#include "statistics/psychometric/psi.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace statistics {
namespace {

/// A person whose psychometric function is known.
struct KnownPerson {
  double threshold, slope;
  std::mt19937_64 random;

  bool answers(double level) {
    return std::uniform_real_distribution<double>()(random) < share_right(level, threshold, slope);
  }
};

Threshold measured(double threshold, double slope, std::uint64_t seed, int questions) {
  KnownPerson person{threshold, slope, std::mt19937_64(seed)};
  Psi psi(0.004, 0.4);
  for (int n = 0; n < questions; ++n) {
    const double level = psi.level();
    psi.answered(level, person.answers(level));
  }
  EXPECT_EQ(psi.answers(), questions);
  return psi.threshold();
}

TEST(ShareRight, IsHalfAtNothingAndThreeQuartersAtTheThresholdButForLapses) {
  // By hand: 0.01 + 0.98 · 0.5 and 0.01 + 0.98 · 0.75; far above 0.01 + 0.98.
  for (const double slope : {0.5, 1.0, 3.0}) {
    EXPECT_NEAR(share_right(1e-12, 0.04, slope), 0.5, 1e-4);
    EXPECT_NEAR(share_right(0.04, 0.04, slope), 0.745, 1e-12);
    EXPECT_NEAR(share_right(1e6, 0.04, slope), 0.99, 1e-9);
  }
}

TEST(ShareRight, IsThatOfTwoLooksWithNormalNoise) {
  // Two looks, each with σ = 0.03: right where d + n₁ − n₂ > 0, Φ(d/(√2 σ)); the threshold is where
  // that is 0.75, √2 · 0.67449 σ = 0.028616. At d = 0.06: Φ(1.41421) = 0.92135 (tables).
  EXPECT_NEAR(share_right(0.06, 0.028616, 1.0), 0.01 + 0.98 * 0.92135, 1e-4);
}

TEST(Psi, BeginsInTheMiddleOfWhatIsAllowed) {
  const Threshold prior = Psi(0.004, 0.4).threshold();
  EXPECT_NEAR(prior.median, 0.04, 0.04 * 0.03);  // √(0.004 · 0.4); the grid's step is 6 %
  EXPECT_LT(prior.interval_95.low, 0.005);
  EXPECT_GT(prior.interval_95.high, 0.32);
}

TEST(Psi, FindsThresholdsWithinTwoDecibelsInThirtyQuestions) {
  // [Kontsevich1999, abstract]: a precision of 2 dB (a factor of 10^(2/20) = 1.26) in less than 30
  // trials of a two-alternative forced choice with a typical slope; here as one standard deviation.
  int within = 0;
  constexpr int kPeople = 60;
  for (int person = 0; person < kPeople; ++person) {
    const Threshold found = measured(0.03, 3.0, std::uint64_t(person), 30);
    within += std::abs(20.0 * std::log10(found.median / 0.03)) < 2.0;
  }
  EXPECT_GE(within, int(0.68 * kPeople));
}

TEST(Psi, HoldsTheTruthWithinItsInterval) {
  int within = 0, of = 0;
  for (const double threshold : {0.015, 0.04, 0.10})
    for (std::uint64_t seed = 100; seed < 140; ++seed, ++of) {
      const Threshold found = measured(threshold, 1.0, seed, 40);
      within += found.interval_95.low <= threshold && threshold <= found.interval_95.high;
    }
  EXPECT_GE(within, int(0.90 * of)) << "of " << of;
}

TEST(Psi, NarrowsWithQuestions) {
  const auto width = [](int questions) {
    const Threshold found = measured(0.04, 1.0, 7, questions);
    return std::log(found.interval_95.high / found.interval_95.low);
  };
  EXPECT_LT(width(80), 0.7 * width(20));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
