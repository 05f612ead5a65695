/// The scores of motion and force on ways whose measures can be worked out by hand.
#include "metrics/tip_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tractus {
namespace metrics {
namespace {

using math::Vec3;
using std::numbers::pi;

constexpr double kStep_s = 1.0 / kMotionRate_Hz;

/// A trial of `seconds` on the motion's own grid: where the tip is and what force acts at a time.
template <class Tip, class Force>
trial::Trial moved(double seconds, const Tip& tip_m, const Force& force_N) {
  trial::Trial out;
  out.header.probe = {{"length_m", 0.1}};
  out.complete = true;
  const int steps = int(std::lround(seconds * kMotionRate_Hz));
  for (int i = 0; i <= steps; ++i) {
    trial::Sample s;
    s.t_s = i * kStep_s;
    s.tick = std::uint32_t(i);
    const Vec3 p = tip_m(s.t_s);
    s.p_VH_m = {p.x(), p.y(), p.z() - 0.1};  // the shank along z
    s.force_N = {0.0f, 0.0f, float(force_N(s.t_s))};
    out.samples.push_back(s);
  }
  return out;
}

template <class Tip>
trial::Trial moved(double seconds, const Tip& tip_m) {
  return moved(seconds, tip_m, [](double) { return 0.0; });
}

double score(const trial::Trial& trial, const std::string& id) {
  volume::Tract tract;
  tract.axis = Vec3::UnitX();
  for (const auto& [info, value] : score_all({.trial = trial, .tract = &tract}))
    if (info.id == id) {
      EXPECT_TRUE(value.value) << id << ": " << value.note;
      return value.value.value_or(std::nan(""));
    }
  ADD_FAILURE() << "no metric " << id;
  return std::nan("");
}

/// A speed of 20 mm/s for 2 s: 40 mm, no jerk, no peak.
trial::Trial straight_line() {
  return moved(2.0, [](double t) { return Vec3(0.02 * t, 0.0, 0.0); });
}

TEST(TipMotion, OfAStraightLineAtConstantSpeedIsItsOwnMeasure) {
  const auto trial = straight_line();
  EXPECT_NEAR(score(trial, "path_length"), 0.04, 1e-12);
  EXPECT_NEAR(score(trial, "depth_path"), 0.04, 1e-12);  // the axis is x
  EXPECT_NEAR(score(trial, "economy_of_motion"), 1.0, 1e-12);
  EXPECT_NEAR(score(trial, "tip_speed_mean"), 0.02, 1e-12);
  EXPECT_NEAR(score(trial, "tip_speed_max"), 0.02, 1e-12);
  EXPECT_NEAR(score(trial, "motion_smoothness"), 0.0, 1e-6);
  EXPECT_EQ(score(trial, "speed_peaks"), 0.0);  // what rounding leaves is no peak
  EXPECT_NEAR(score(trial, "tremor_rms"), 0.0, 1e-3 * 0.04);
}

TEST(TipMotion, ToAndFroCountsBothWaysAlongTheAxis) {
  // x = 10 mm sin(2π t): |v| integrates to 4 · 10 mm a second; its peaks inside (0, 2 s) are at
  // 0.5, 1 and 1.5 s, 2π · 10 mm/s high. Along y nothing of it counts as depth.
  const auto wave = [](double t) { return 0.01 * std::sin(2.0 * pi * t); };
  const auto along = moved(2.0, [&](double t) { return Vec3(wave(t), 0.0, 0.0); });
  EXPECT_NEAR(score(along, "depth_path"), 0.08, 2e-4);
  EXPECT_NEAR(score(along, "path_length"), 0.08, 2e-4);
  EXPECT_NEAR(score(along, "economy_of_motion"), 0.0, 1e-9);
  EXPECT_NEAR(score(along, "tip_speed_max"), 0.02 * pi, 1e-4);
  EXPECT_EQ(score(along, "speed_peaks"), 3.0);
  const auto across = moved(2.0, [&](double t) { return Vec3(0.0, wave(t), 0.0); });
  EXPECT_NEAR(score(across, "depth_path"), 0.0, 1e-12);
  EXPECT_NEAR(score(across, "path_length"), 0.08, 2e-4);
}

TEST(TipMotion, OfACircleFollowsFromRadiusAndTurns) {
  // r = 10 mm, ω = π rad/s, two turns in 4 s. The jerk is r ω³, the path r ω T, so the jerk's
  // measure √(T⁵ r² ω⁶ T / (2 r² ω² T²)) is (ω T)² / √2.
  const double r = 0.01, omega = pi, t_s = 4.0;
  const auto trial = moved(
      t_s, [&](double t) { return Vec3(0.0, r * std::cos(omega * t), r * std::sin(omega * t)); });
  EXPECT_NEAR(score(trial, "path_length"), r * omega * t_s, 1e-5);
  EXPECT_NEAR(score(trial, "tip_speed_mean"), r * omega, 3e-6);
  EXPECT_NEAR(score(trial, "tip_speed_max"), r * omega, 3e-6);
  EXPECT_NEAR(score(trial, "economy_of_motion"), 0.0, 1e-9);
  EXPECT_NEAR(score(trial, "depth_path"), 0.0, 1e-12);
  const double smoothness = std::pow(omega * t_s, 2) / std::numbers::sqrt2;
  EXPECT_NEAR(score(trial, "motion_smoothness"), smoothness, 0.005 * smoothness);
}

TEST(TipMotion, OfAMinimumJerkMovementHasThePublishedMeasures) {
  // x = D (10 s³ − 15 s⁴ + 6 s⁵), s = t/T: ∫ jerk² = 720 D²/T⁵, so √360; the peak speed is 15/8 of
  // the mean; −ln 204.8 and −1.41 are the values of [Balasubramanian2015]. D = 0.1 m in T = 4 s, so
  // that the fit's window of 0.1 s does not show.
  const auto trial = moved(4.0, [](double t) {
    const double s = 0.25 * t;
    return Vec3(0.1 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 0.0, 0.0);
  });
  EXPECT_NEAR(score(trial, "path_length"), 0.1, 1e-6);
  EXPECT_NEAR(score(trial, "economy_of_motion"), 1.0, 1e-5);
  EXPECT_NEAR(score(trial, "tip_speed_mean"), 0.025, 1e-6);
  EXPECT_NEAR(score(trial, "tip_speed_max"), 0.046875, 1e-6);
  EXPECT_NEAR(score(trial, "motion_smoothness"), std::sqrt(360.0), 0.1);
  EXPECT_NEAR(score(trial, "log_dimensionless_jerk"), -std::log(204.8), 0.1);
  EXPECT_NEAR(score(trial, "spectral_arc_length"), -1.41, 0.02);
  EXPECT_EQ(score(trial, "speed_peaks"), 1.0);
}

TEST(TipMotion, AStopOnTheWayIsLessSmoothThanNone) {
  // The same way in two strokes, one after the other.
  const auto stroke = [](double s) { return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s); };
  const auto once = moved(2.0, [&](double t) { return Vec3(0.1 * stroke(0.5 * t), 0.0, 0.0); });
  const auto twice = moved(2.0, [&](double t) {
    return Vec3(0.05 * (stroke(std::min(t, 1.0)) + stroke(std::max(t - 1.0, 0.0))), 0.0, 0.0);
  });
  EXPECT_EQ(score(twice, "speed_peaks"), 2.0);
  EXPECT_LT(score(twice, "spectral_arc_length"), score(once, "spectral_arc_length"));
  EXPECT_LT(score(twice, "log_dimensionless_jerk"), score(once, "log_dimensionless_jerk"));
  EXPECT_GT(score(twice, "motion_smoothness"), score(once, "motion_smoothness"));
}

TEST(TipMotion, TremorIsTheRootMeanSquareOfItsBandAlone) {
  // 0.1 mm at 10 Hz: 0.1/√2 mm, by √2 more on two axes; at 3 Hz nothing of it.
  const auto wave = [](double t, double f) { return 1e-4 * std::sin(2.0 * pi * f * t); };
  const auto one = moved(6.0, [&](double t) { return Vec3(wave(t, 10.0), 0.0, 0.0); });
  const auto two = moved(6.0, [&](double t) { return Vec3(wave(t, 10.0), 0.0, wave(t, 10.0)); });
  const auto slow = moved(6.0, [&](double t) { return Vec3(wave(t, 3.0), 0.0, 0.0); });
  EXPECT_NEAR(score(one, "tremor_rms"), 1e-4 / std::numbers::sqrt2, 1e-6);
  EXPECT_NEAR(score(two, "tremor_rms"), 1e-4, 1e-6);
  EXPECT_NEAR(score(slow, "tremor_rms"), 0.0, 1e-6);
}

TEST(TipForce, ImpulseRateAndContactFollowTheForce) {
  const auto still = [](double) { return Vec3(0.0, 0.0, 0.0); };
  const auto held = moved(3.0, still, [](double) { return 2.0; });
  EXPECT_NEAR(score(held, "force_impulse"), 6.0, 1e-9);
  EXPECT_NEAR(score(held, "force_rate_max"), 0.0, 1e-9);
  EXPECT_EQ(score(held, "contact_share"), 1.0);
  // 4 N/s for 2 s: half of 8 N over 2 s.
  const auto ramp = moved(2.0, still, [](double t) { return 4.0 * t; });
  EXPECT_NEAR(score(ramp, "force_impulse"), 8.0, 1e-5);
  EXPECT_NEAR(score(ramp, "force_rate_max"), 4.0, 1e-4);
  // The size of the force: pulling counts as pushing does.
  const auto pull = moved(2.0, still, [](double t) { return -4.0 * t; });
  EXPECT_NEAR(score(pull, "force_impulse"), 8.0, 1e-5);
  // 201 samples, contact from 0.25 s on: 151 of them.
  const auto late = moved(1.0, still, [](double t) { return t < 0.2499 ? 0.0 : 1.0; });
  EXPECT_NEAR(score(late, "contact_share"), 151.0 / 201.0, 1e-12);
}

TEST(TipMotion, OfAProbingTrialIsAlongItsDepth) {
  // 10 mm/s for 2 s against 1000 N/m: 20 mm, ½ · 1000 · 0.02² = 0.2 J; 0 to 20 N over 2 s.
  trial::Trial trial;
  trial.header.rig = trial::Rig::probing;
  trial.header.rate_Hz = 1000.0;
  trial.complete = true;
  for (int i = 0; i <= 2000; ++i) {
    trial::ProbingSample s;
    s.t_s = i / 1000.0;
    s.tick = std::uint32_t(i);
    s.x_m = 0.01 * s.t_s;
    s.speed_m_s = 0.01f;
    s.fz_N = float(1000.0 * s.x_m);
    s.mode = trial::ProbingMode::bone;
    trial.probing.push_back(s);
  }
  EXPECT_NEAR(score(trial, "probing_work"), 0.2, 1e-6);
  EXPECT_NEAR(score(trial, "force_impulse"), 20.0, 1e-4);
  EXPECT_NEAR(score(trial, "force_rate_max"), 10.0, 1e-3);
  EXPECT_NEAR(score(trial, "economy_of_motion"), 1.0, 1e-9);
  EXPECT_NEAR(score(trial, "tip_speed_mean"), 0.01, 1e-9);
  EXPECT_NEAR(score(trial, "tip_speed_max"), 0.01, 1e-9);
  EXPECT_EQ(score(trial, "speed_peaks"), 0.0);
}

TEST(TipMotion, TooShortOrAtRestHasNoMeasureAndAReason) {
  const auto still = [](double) { return Vec3(0.01, 0.0, 0.0); };
  for (const auto& [info, value] : score_all({.trial = moved(0.1, still)}))
    if (info.id == "motion_smoothness" || info.id == "tremor_rms" ||
        info.id == "spectral_arc_length") {
      EXPECT_FALSE(value.value) << info.id;
      EXPECT_FALSE(value.note.empty()) << info.id;
    }
  for (const auto& [info, value] : score_all({.trial = moved(2.0, still)}))
    if (info.id == "motion_smoothness" || info.id == "economy_of_motion" ||
        info.id == "spectral_arc_length" || info.id == "log_dimensionless_jerk") {
      EXPECT_FALSE(value.value) << info.id;
      EXPECT_FALSE(value.note.empty()) << info.id;
    }
}

}  // namespace
}  // namespace metrics
}  // namespace tractus
