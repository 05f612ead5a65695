#include "lab/signal/smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>
#include <random>

#include "lab/signal/decimator.hpp"
#include "lab/signal/drift.hpp"
#include "lab/signal/fading_memory.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr double kPi = std::numbers::pi;

struct Recorded {
  std::vector<double> t_s, y, rate, acceleration;
};

/// 10 mm at 0.3 Hz and 2 mm at 1.1 Hz with noise; the derivatives are analytic.
Recorded sines(double rate_Hz, double seconds, double noise, double jitter_s = 0.0) {
  std::mt19937_64 random(7);
  std::normal_distribution<> normal;
  Recorded r;
  for (int k = 0; k < int(seconds * rate_Hz); ++k) {
    const double t = k / rate_Hz + jitter_s * std::sin(k * 12.9898);
    const double a = 2.0 * kPi * 0.3, b = 2.0 * kPi * 1.1;
    r.t_s.push_back(t);
    r.y.push_back(0.01 * std::sin(a * t) + 0.002 * std::sin(b * t) + noise * normal(random));
    r.rate.push_back(0.01 * a * std::cos(a * t) + 0.002 * b * std::cos(b * t));
    r.acceleration.push_back(-0.01 * a * a * std::sin(a * t) - 0.002 * b * b * std::sin(b * t));
  }
  return r;
}

double rms_of_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / double(a.size()));
}

TEST(Smoother, NoiseIsFoundWithinAFewPercent) {
  for (const double noise : {5e-7, 5e-6})
    EXPECT_NEAR(noise_sd(sines(1000.0, 8.0, noise).y), noise, 0.04 * noise);
}

TEST(FadingMemory, OfAConstantSpeedIsThatOfAFirstOrderLag) {
  // y' = v − y/τ from 0: y = vτ(1 − e^(−t/τ)).
  std::vector<double> t_s, v_m_s;
  for (int k = 0; k < 400; ++k) t_s.push_back(0.003 * k + 0.001 * (k % 2)), v_m_s.push_back(0.02);
  const auto y_m = fading_memory(t_s, v_m_s, 0.15);
  for (std::size_t k = 0; k < t_s.size(); ++k)
    EXPECT_NEAR(y_m[k], 0.02 * 0.15 * (1.0 - std::exp(-t_s[k] / 0.15)), 1e-12);
}

TEST(Decimator, KnowsTheThirdDifferencesOfWhiteNoise) {
  std::mt19937_64 random(5);
  std::normal_distribution<> normal;
  std::vector<double> noise(400'000);
  for (double& v : noise) v = normal(random);
  const Decimator decimator(1e-3, 100.0);
  std::vector<double> thin(decimator.size(noise.size()));
  decimator.apply(noise, thin);
  double squares = 0.0;
  for (std::size_t k = 3; k < thin.size(); ++k)
    squares += std::pow(thin[k] - 3.0 * thin[k - 1] + 3.0 * thin[k - 2] - thin[k - 3], 2);
  EXPECT_NEAR(squares / 20.0 / double(thin.size() - 3), decimator.third_difference_gain(),
              0.03 * decimator.third_difference_gain());
}

TEST(Smoother, AtABreakTheSpeedMayJump) {
  // 10 mm/s, from 0.5004 s on 2 mm/s: the jump lies 0.4 of the way between two samples.
  std::mt19937_64 random(3);
  std::normal_distribution<> normal;
  const double at_s = 0.5004, noise_m = 5e-7;
  std::vector<double> t_s, y, rate;
  for (int k = 0; k < 1000; ++k) {
    const double t = k * 1e-3;
    t_s.push_back(t);
    rate.push_back(t < at_s ? 0.010 : 0.002);
    y.push_back((t < at_s ? 0.010 * t : 0.010 * at_s + 0.002 * (t - at_s)) +
                noise_m * normal(random));
  }
  const auto worst_near = [&](const Smoothed& s) {
    double worst = 0.0;
    for (std::size_t k = 480; k < 520; ++k) worst = std::max(worst, std::abs(s.rate[k] - rate[k]));
    return worst;
  };
  EXPECT_GT(worst_near(smooth(t_s, y, noise_m)), 1e-3);
  EXPECT_LT(worst_near(smooth(t_s, y, noise_m, {{501, 0.4}})), 3e-4);
}

TEST(Smoother, KinksEveryTwentiethOfASecondAreNoNoise) {
  auto r = sines(1000.0, 8.0, 5e-7);
  for (std::size_t k = 0; k < r.y.size(); ++k) r.y[k] += (k / 50) % 2 ? 1e-3 : 0.0;
  EXPECT_NEAR(noise_sd(r.y), 5e-7, 0.15 * 5e-7);
}

TEST(Smoother, AMotionOfAFewSamplesAPeriodKeepsItsAcceleration) {
  // 0.1 mm at 60 Hz and 20 um at 140 Hz, 750 samples a second, 5 nm of noise; the derivatives are analytic.
  std::mt19937_64 random(8);
  std::normal_distribution<> normal;
  Recorded r;
  const double a = 2.0 * kPi * 60.0, b = 2.0 * kPi * 140.0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k / 750.0;
    r.t_s.push_back(t);
    r.y.push_back(1e-4 * std::sin(a * t) + 2e-5 * std::sin(b * t) + 5e-9 * normal(random));
    r.acceleration.push_back(-1e-4 * a * a * std::sin(a * t) - 2e-5 * b * b * std::sin(b * t));
  }
  const double noise = noise_sd_on_fast_motion(r.y);
  EXPECT_GT(noise_sd(r.y), 100.0 * 5e-9);  // third differences hold the motion
  // Ninth differences pass (2 sin(pi 140/750))^9 = 2.5 of the faster sine, and sqrt(48620) = 220 of noise.
  EXPECT_LT(noise, 1.5 * 2e-5 / std::sqrt(2.0) * 2.5 / 220.0);
  const Smoothed s = smooth(r.t_s, r.y, noise);
  const std::vector<double> none(r.acceleration.size(), 0.0);
  EXPECT_LT(rms_of_difference(s.acceleration, r.acceleration),
            0.03 * rms_of_difference(none, r.acceleration));
}

TEST(Smoother, OnASlowMotionHigherDifferencesChangeNothing) {
  const auto r = sines(1000.0, 8.0, 5e-7);
  EXPECT_EQ(noise_sd_on_fast_motion(r.y), noise_sd(r.y));
}

TEST(Smoother, APositionThatStandsOnItsRoundingIsNotSeenToMove) {
  // A creep to a rest, 35 mm (1 − e^(−t/2 s)), counted in steps of 5 µm: after 30 s less than a
  // step is left to go.
  std::vector<double> t_s, y;
  for (int k = 0; k < 90'000; ++k) {
    t_s.push_back(1e-3 * k);
    y.push_back(5e-6 * std::round(0.035 * (1.0 - std::exp(-0.5 * t_s.back())) / 5e-6));
  }
  const Smoothed s = smooth(t_s, y, 5e-6 / std::sqrt(12.0));
  double moving = 0.0, standing = 0.0;
  for (std::size_t k = 0; k < 5'000; ++k)
    moving = std::max(moving, std::abs(s.rate[k] - 0.0175 * std::exp(-0.5 * t_s[k])));
  for (std::size_t k = 30'000; k < y.size(); ++k)
    standing = std::max(standing, std::abs(s.rate[k]));
  EXPECT_LT(moving, 3e-4);
  EXPECT_LT(standing, 2e-5);
}

TEST(Smoother, SpeedOfAHandIsKnownToAFewMicrometresPerSecond) {
  // Half a micrometre of noise at 1 kHz under a cut-off of some 5 Hz leaves about
  // 2π √(2 σ² f0³/(3 fs)) = 1 µm/s; plain differences would leave 700.
  const auto r = sines(1000.0, 8.0, 5e-7);
  const Smoothed s = smooth(r.t_s, r.y, noise_sd(r.y));
  EXPECT_LT(rms_of_difference(s.rate, r.rate), 1e-5);
  EXPECT_LT(rms_of_difference(s.acceleration, r.acceleration), 5e-3);
}

TEST(Smoother, StandardErrorsAreOfTheSizeOfTheErrors) {
  for (const double rate_Hz : {200.0, 1000.0, 4000.0}) {
    const auto r = sines(rate_Hz, 8.0, 5e-6);
    const Smoothed s = smooth(r.t_s, r.y, noise_sd(r.y));
    double sum = 0.0;
    for (std::size_t k = 0; k < r.t_s.size(); ++k)
      sum += std::pow((s.rate[k] - r.rate[k]) / s.rate_sd[k], 2);
    const double mean = sum / double(r.t_s.size());
    EXPECT_GT(mean, 0.2) << rate_Hz;
    EXPECT_LT(mean, 2.0) << rate_Hz;
  }
}

TEST(Smoother, UnevenTimeStampsAreTakenAsTheyAre) {
  const auto r = sines(1000.0, 6.0, 5e-7, 2e-4);
  const Smoothed s = smooth(r.t_s, r.y, 5e-7);
  EXPECT_LT(rms_of_difference(s.rate, r.rate), 1e-5);
}

TEST(Smoother, AKinkIsFollowedAndItsErrorOwnedUpTo) {
  // Speed jumps from 20 mm/s to rest at 2 s: known well away from it, poorly at it, and said so.
  std::mt19937_64 random(3);
  std::normal_distribution<> normal;
  std::vector<double> t_s, y;
  for (int k = 0; k < 4000; ++k) {
    t_s.push_back(k * 1e-3);
    y.push_back(0.02 * std::min(t_s.back(), 2.0) + 5e-7 * normal(random));
  }
  const Smoothed s = smooth(t_s, y, 5e-7);
  EXPECT_NEAR(s.rate[1500], 0.02, 5e-5);
  EXPECT_NEAR(s.rate[2500], 0.0, 5e-5);
  EXPECT_GT(s.rate_sd[2000], 5.0 * s.rate_sd[1000]);
}

TEST(Smoother, NoiseThatIsSaidToBeNearlyNothingLeavesTheSpeedRight) {
  std::vector<double> t_s, y;
  for (int k = 0; k < 4000; ++k) {
    t_s.push_back(k / 1000.0);
    y.push_back(k < 2000 ? 0.0 : 8.0 * (t_s.back() - 2.0));  // still, then at 8 a second
  }
  const Smoothed s = smooth(t_s, y, 1e-12);
  for (std::size_t k = 0; k < y.size(); ++k)
    if (k < 1900 || k > 2100) {
      EXPECT_NEAR(s.rate[k], k < 2000 ? 0.0 : 8.0, 0.01) << k;
    }
}

TEST(Smoother, LongRecordingsAreSmoothedInStretchesWithoutASeam) {
  const auto r = sines(1000.0, 140.0, 5e-7);
  const Smoothed s = smooth(r.t_s, r.y, 5e-7);
  for (std::size_t k = 63'000; k < 67'000; ++k) ASSERT_NEAR(s.rate[k], r.rate[k], 1e-4) << k;
}

TEST(Decimator, PassesRestUnchangedAndStopsWhatWouldFold) {
  const Decimator d(1e-3, 100.0);
  EXPECT_EQ(d.stride(), 10u);
  std::vector<double> constant(1000, 3.0), fast(1000), out(d.size(1000));
  for (std::size_t k = 0; k < fast.size(); ++k)
    fast[k] = std::sin(2.0 * kPi * 90.0 * double(k) * 1e-3);
  d.apply(constant, out);
  for (const double v : out) EXPECT_NEAR(v, 3.0, 1e-12);
  d.apply(fast, out);
  for (const double v : out) EXPECT_LT(std::abs(v), 0.02);
}

TEST(Decimator, LeavesASlowRecordingAsItIs) {
  const Decimator d(1.0 / 120.0, 100.0);
  EXPECT_EQ(d.stride(), 1u);
  EXPECT_EQ(d.size(50), 50u);
}

TEST(Decimator, GivesTheOutputsThatWereChosenAsItGaveThemAmongAll) {
  const auto r = sines(1000.0, 1.0, 0.0);
  Decimator all(1e-3, 100.0);
  std::vector<double> every(all.size(r.y.size()));
  all.apply(r.y, every);
  Decimator some = all;
  some.choose({0, 7, 31});
  std::vector<double> chosen(some.size(r.y.size()));
  some.apply(r.y, chosen);
  EXPECT_EQ(chosen, (std::vector{every[0], every[7], every[31]}));
  EXPECT_EQ(some.middle(1), all.middle(7));
}

TEST(Decimator, OfEveryOtherSampleGivesTheSameOutputsOfASlowSignal) {
  const auto r = sines(2000.0, 1.0, 0.0);
  Decimator all(5e-4, 100.0);
  all.choose({0, 3, 8, 60});
  std::vector<double> fine(4), coarse(4), thinned;
  all.apply(r.y, fine);
  const Decimator some = all.of_every(2);
  for (std::size_t k = all.half() % 2; k < r.y.size(); k += 2) thinned.push_back(r.y[k]);
  some.apply(thinned, coarse);
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(coarse[j], fine[j], 1e-3 * std::abs(fine[j]) + 1e-9);
    EXPECT_EQ(all.half() % 2 + 2 * some.middle(j), all.middle(j));
  }
}

TEST(Drift, TakesOutAPolynomialAndGivesItBack) {
  std::vector<double> t_s, sd;
  Eigen::VectorXd residual(200);
  for (int k = 0; k < 200; ++k) {
    const double t = 0.05 * k;
    t_s.push_back(t);
    sd.push_back(k % 2 ? 0.1 : 0.2);
    residual(k) = (1.0 + 0.3 * t - 0.02 * t * t) / sd.back();
  }
  const Drift drift(t_s, sd);
  const Eigen::VectorXd back = drift.at(t_s, drift.fit(residual));
  EXPECT_NEAR(back(100), 1.0 + 0.3 * 5.0 - 0.02 * 25.0, 1e-9);
  drift.remove(residual);
  EXPECT_LT(residual.norm(), 1e-9);
}

// By the textbook's (XᵀWX)⁻¹ on monomials, which span what the Legendre polynomials span.
TEST(Drift, KnowsHowWellItKnowsADifference) {
  std::vector<double> t_s, sd;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6, 6);
  const auto monomials = [](double t) {
    return Eigen::VectorXd{{1.0, t, t * t, std::pow(t, 3), std::pow(t, 4), std::pow(t, 5)}};
  };
  for (int k = 0; k < 200; ++k) {
    t_s.push_back(-1.0 + 0.01 * k);
    sd.push_back(k % 2 ? 0.1 : 0.2);
    const Eigen::VectorXd x = monomials(t_s.back()) / sd.back();
    information += x * x.transpose();
  }
  const Eigen::VectorXd contrast = monomials(0.9) - monomials(-0.4);
  const double expected = contrast.dot(information.ldlt().solve(contrast));
  EXPECT_NEAR(Drift(t_s, sd).variance_between(0.9, -0.4) / expected, 1.0, 1e-9);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
