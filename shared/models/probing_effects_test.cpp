/// Each effect of the probing rig against values worked out by hand from its equation.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/probing_runtime.hpp"

namespace tractus {
namespace models {
namespace {

constexpr double kPi = std::numbers::pi;

/// What the effects alone ask for: a model without layers.
std::vector<double> force_N(std::vector<effects::EffectInstance> uses, const ProbingMotion& motion,
                            std::vector<laws::Layer> layers = {}) {
  ProbingModel model;
  model.layers = std::move(layers);
  model.effects = std::move(uses);
  const auto runtime = ProbingRuntime::make(model, 0.1);
  EXPECT_TRUE(runtime) << runtime.error().what;
  ProbingForces forces;
  runtime->predict(motion, forces);
  return forces.fz_N;
}

/// One moment.
ProbingMotion moment(double x_m, double v_m_s, double a_m_s2 = 0.0) {
  return {.t_s = {0.0}, .x_m = {x_m}, .v_m_s = {v_m_s}, .a_m_s2 = {a_m_s2}, .rest_m_s = 0.0};
}

/// A path of n + 1 samples over `length_s`; speed and acceleration are left to the caller.
template <class Depth, class Speed>
ProbingMotion path(int n, double length_s, const Depth& x_m, const Speed& v_m_s) {
  ProbingMotion m{.rest_m_s = 0.0};
  for (int k = 0; k <= n; ++k) {
    const double t = length_s * k / n;
    m.t_s.push_back(t);
    m.x_m.push_back(x_m(t));
    m.v_m_s.push_back(v_m_s(t));
    m.a_m_s2.push_back(0.0);
  }
  return m;
}

TEST(Inertia, IsMassTimesAcceleration) {
  EXPECT_NEAR(force_N({{"inertia", {1.5}}}, moment(0.01, 0.02, -4.0))[0], -6.0, 1e-12);
}

TEST(StribeckFriction, FallsFromBreakawayToFrictionAtSpeed) {
  // F_c = 1 N, F_s = 3 N, v_s = 4 mm/s; at v = v_s: 1 + 2/e = 1.73575888 N; at 10 v_s: 1 N.
  const effects::EffectInstance use{"stribeck_friction", {1.0, 3.0, 0.004}};
  EXPECT_NEAR(force_N({use}, moment(0.01, 0.004))[0], 1.7357588823, 1e-9);
  EXPECT_NEAR(force_N({use}, moment(0.01, -0.004))[0], -1.7357588823, 1e-9);
  EXPECT_NEAR(force_N({use}, moment(0.01, 1e-9))[0], 3.0, 1e-9);
  EXPECT_NEAR(force_N({use}, moment(0.01, 0.04))[0], 1.0, 1e-9);
}

TEST(QuadraticDrag, GrowsWithTheSquareOfTheSpeedAndOpposesIt) {
  // 5000 N·s²/m² · (0.02 m/s)² = 2 N
  EXPECT_NEAR(force_N({{"quadratic_drag", {5000.0}}}, moment(0.0, 0.02))[0], 2.0, 1e-12);
  EXPECT_NEAR(force_N({{"quadratic_drag", {5000.0}}}, moment(0.0, -0.02))[0], -2.0, 1e-12);
}

TEST(ViscoelasticRelaxation, FollowsTheMaxwellBranchAtAnyRate) {
  // v = 10 mm/s for 0.3 s, then rest: q(t) = v τ (1 − e^(−t/τ)), then q(0.3) e^(−(t − 0.3)/τ).
  // τ = 0.5 s, k = 800 N/m: q(0.3) = 0.005 · 0.4511883639 m → 1.8047534556 N; at 0.8 s that times
  // e⁻¹ = 0.6639316927 N. Exact for constant speed, so also with 8 samples.
  for (const int n : {8, 400, 3200}) {
    const auto m = path(
        n, 0.8, [](double t) { return 0.01 * std::min(t, 0.3); },
        [](double t) { return t < 0.3 ? 0.01 : 0.0; });
    const auto f = force_N({{"viscoelastic_relaxation", {800.0, 0.5}}}, m);
    EXPECT_NEAR(f[std::size_t(n * 3 / 8)], 1.8047534556, 1e-9) << n;
    EXPECT_NEAR(f.back(), 0.6639316927, 1e-9) << n;
  }
}

TEST(ViscoelasticRelaxation, IsOfSecondOrderUnderAnAcceleratedMotion) {
  // x = A sin ωt from rest of q: q = A ω τ/(1 + (ωτ)²) (cos ωt + ωτ sin ωt − e^(−t/τ)).
  const double A = 0.004, w = 12.0, tau = 0.2, t = 0.7, k = 1000.0;
  const double wt = w * tau;
  const double exact_N = k * A * w * tau / (1.0 + wt * wt) *
                         (std::cos(w * t) + wt * std::sin(w * t) - std::exp(-t / tau));
  const auto error_N = [&](int n) {
    const auto m = path(
        n, t, [&](double s) { return A * std::sin(w * s); },
        [&](double s) { return A * w * std::cos(w * s); });
    return std::abs(force_N({{"viscoelastic_relaxation", {k, tau}}}, m).back() - exact_N);
  };
  EXPECT_LT(error_N(350), 1e-4);  // 500 Hz
  EXPECT_LT(error_N(700), 0.3 * error_N(350));
}

TEST(Hysteresis, BuildsUpOverTheDisplacementWhateverTheRate) {
  // From rest over Δ = 0.2 mm with δ = 0.1 mm: z = δ (1 − e⁻²) → k z = 2 N · 0.8646647168 =
  // 1.7293294335 N; then back by 0.1 mm: z → −δ + (z + δ) e⁻¹: 2 (−1 + 1.8646647168 · 0.3678794412)
  // = −0.6280563720 N.
  const auto there_and_back = [](double t) { return t < 2.0 ? 1e-4 * t : 2e-4 - 1e-4 * (t - 2.0); };
  for (const int n : {3, 30, 3000}) {
    const auto f = force_N({{"hysteresis", {2e4, 1e-4}}},
                           path(n, 3.0, there_and_back, [](double) { return 0.0; }));
    EXPECT_NEAR(f[std::size_t(n * 2 / 3)], 1.7293294335, 1e-9) << n;
    EXPECT_NEAR(f.back(), -0.6280563720, 1e-9) << n;
  }
}

TEST(BoucWen, SoftensAndUnloadsInClosedForm) {
  // k = 2e4 N/m, δ = 0.1 mm, g = 0.5, in by 0.1 mm: z = δ (1 − e^(−1.5))/1.5 → 1.035826453 N; back
  // by 0.02 mm: z = (z + 2 δ) e^(−0.1) − 2 δ → 0.556604206 N.
  const auto there_and_back = [](double t) { return t < 1.0 ? 1e-4 * t : 1e-4 - 1e-4 * (t - 1.0); };
  for (const int n : {6, 600}) {
    const auto f = force_N({{"bouc_wen", {2e4, 1e-4, 0.5}}},
                           path(n, 1.2, there_and_back, [](double) { return 0.0; }));
    EXPECT_NEAR(f[std::size_t(n * 5 / 6)], 1.035826453, 1e-8) << n;
    EXPECT_NEAR(f.back(), 0.556604206, 1e-8) << n;
  }
}

TEST(BoucWen, IsDahlsWithoutItsShape) {
  const auto wave = path(
      2000, 2.0, [](double t) { return 1e-3 * std::sin(5.0 * t) + 2e-4 * std::sin(31.0 * t); },
      [](double) { return 0.0; });
  const auto a = force_N({{"bouc_wen", {2e4, 1e-4, 0.0}}}, wave);
  const auto b = force_N({{"hysteresis", {2e4, 1e-4}}}, wave);
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-9) << k;
}

TEST(DirectionDependentDrag, AddsInAndTakesOut) {
  // 50 N·s/m · 0.02 m/s = 1 N either way.
  const auto drag = [](double v_m_s, double mean_Ns_per_m) {
    return force_N({{"direction_dependent_drag", {50.0, mean_Ns_per_m}}}, moment(0.0, v_m_s))[0];
  };
  EXPECT_NEAR(drag(0.02, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(drag(-0.02, 0.0), 1.0, 1e-12);
  // On the way in alone: 2 · 50 N·s/m · 0.02 m/s there, nothing on the way out.
  EXPECT_NEAR(drag(0.02, 50.0), 2.0, 1e-12);
  EXPECT_NEAR(drag(-0.02, 50.0), 0.0, 1e-12);
}

TEST(Hysteresis, StaysWhereItIsWhileTheProbeRests) {
  const auto f = force_N({{"hysteresis", {2e4, 1e-4}}},
                         path(
                             3000, 3.0, [](double t) { return std::min(1e-4 * t, 1e-4); },
                             [](double) { return 0.0; }));
  EXPECT_EQ(f[1500], f[3000]);
}

TEST(Backlash, LetsTheBoneSeeTheDepthThroughTheDeadZone) {
  // K = 4000 N/m, D = 1000 N·s/m, gap 0.4 mm, start at 10 mm. In by 1 mm: seen 10.8 mm → 43.2 N;
  // back by 0.3 mm: still 43.2; back by 0.6 mm (10.4): seen 10.6 → 42.4. Damping acts all along.
  const auto x = [](double t) { return t < 1.0 ? 0.010 + 0.001 * t : 0.011 - 0.001 * (t - 1.0); };
  const auto m = path(1600, 1.6, x, [](double t) { return t < 1.0 ? 0.001 : -0.001; });
  const auto f = force_N({{"backlash", {4e-4, 0.0}}}, m, {{0.0, 0.05, 4000.0, 1000.0, 0.0}});
  EXPECT_NEAR(f[100], 4000.0 * 0.010 + 1.0, 1e-9);  // 0.1 mm in: within the half gap of the start
  EXPECT_NEAR(f[999], 4000.0 * (0.010999 - 0.0002) + 1.0, 1e-9);
  EXPECT_NEAR(f[1300], 43.2 - 1.0, 1e-9);
  EXPECT_NEAR(f[1600], 42.4 - 1.0, 1e-9);
}

TEST(Backlash, InterruptsTheDampingWhereItIsTheBones) {
  // 0.4 mm of play from 10 mm, in at 1 mm/s: nothing pushes on the damper for 0.2 mm; after turning
  // back at 11 mm, none for 0.4 mm. D v = 1 N.
  const auto x = [](double t) { return t < 1.0 ? 0.010 + 0.001 * t : 0.011 - 0.001 * (t - 1.0); };
  const auto m = path(1600, 1.6, x, [](double t) { return t < 1.0 ? 0.001 : -0.001; });
  const auto f = force_N({{"backlash", {4e-4, 1.0}}}, m, {{0.0, 0.05, 4000.0, 1000.0, 0.0}});
  EXPECT_NEAR(f[199], 40.0, 1e-9);
  EXPECT_NEAR(f[202], 4000.0 * 0.010002 + 1.0, 1e-9);
  EXPECT_NEAR(f[1398], 43.2, 1e-9);
  EXPECT_NEAR(f[1600], 42.4 - 1.0, 1e-9);
}

TEST(DepthFriction, GrowsWithTheDepthAndOpposesTheMotion) {
  EXPECT_NEAR(force_N({{"depth_friction", {120.0}}}, moment(0.02, 0.001))[0], 2.4, 1e-12);
  EXPECT_NEAR(force_N({{"depth_friction", {120.0}}}, moment(0.02, -0.5))[0], -2.4, 1e-12);
  EXPECT_EQ(force_N({{"depth_friction", {120.0}}}, moment(-0.002, 0.001))[0], 0.0);
}

TEST(RotationCoupling, DividesTheBonesResistanceAlone) {
  // (4000 · 0.01 + 1000 · 0.01) / (1 + 0.25 · 2) = 33.3333 N, friction 3 N untouched.
  auto m = moment(0.01, 0.01);
  m.omega_rad_s = {-2.0};
  m.theta_rad = {0.0};
  const auto f = force_N({{"coulomb_friction", {3.0}}, {"rotation_coupling", {0.25}}}, m,
                         {{0.0, 0.05, 4000.0, 1000.0, 0.0}});
  EXPECT_NEAR(f[0], 50.0 / 1.5 + 3.0, 1e-12);
}

TEST(ForceRipple, ComesBackAfterItsPeriodOfDepth) {
  const effects::EffectInstance use{"force_ripple", {0.7, 0.002, kPi / 6.0}};
  EXPECT_NEAR(force_N({use}, moment(0.0, 0.0))[0], 0.35, 1e-12);  // sin 30°
  EXPECT_NEAR(force_N({use}, moment(0.0125, 0.0))[0], 0.7 * std::sin(kPi / 2.0 + kPi / 6.0), 1e-12);
}

TEST(SensorDrift, IsReplayedAsARampOfItsRangeCentredAtZero) {
  const auto m = path(
      4, 8.0, [](double) { return 0.0; }, [](double) { return 0.0; });
  const auto f = force_N({{"sensor_drift", {0.8}}}, m);
  EXPECT_NEAR(f[0], -0.4, 1e-12);
  EXPECT_NEAR(f[1], -0.2, 1e-12);
  EXPECT_NEAR(f[4], 0.4, 1e-12);
}

TEST(TimeDelay, RecordsTheForceOfEarlier) {
  // D v = 1000 N·s/m · 0.01 m/s · sin(2π 5 Hz t), late by 7.3 ms of samples at 1 kHz.
  const auto sine = [](double t) { return 0.01 * std::sin(2.0 * kPi * 5.0 * t); };
  const auto m = path(
      1000, 1.0, [](double) { return 0.01; }, sine);
  const auto f = force_N({{"time_delay", {7.3e-3}}}, m, {{0.0, 0.05, 0.0, 1000.0, 0.0}});
  for (const std::size_t k : {20u, 333u, 1000u})
    EXPECT_NEAR(f[k], 1000.0 * sine(m.t_s[k] - 7.3e-3), 1e-4) << k;
  EXPECT_EQ(f[3], 0.0);  // before the recording began: as at its first sample
}

TEST(TorqueCrosstalk, AddsAShareOfTheTorqueRecorded) {
  auto m = moment(0.0, 0.0);
  m.tz_Nm = {0.06};
  EXPECT_NEAR(force_N({{"torque_crosstalk", {20.0}}}, m)[0], 1.2, 1e-12);
  m.tz_Nm = {};
  EXPECT_EQ(force_N({{"torque_crosstalk", {20.0}}}, m)[0], 0.0);
}

TEST(MeasurementEffects, DelayTheLawButNotTheSensorsOwnErrors) {
  // 10 N of damping from 0.5 s on, 20 ms late; the bias is there from the start.
  const auto m = path(
      100, 1.0, [](double) { return 0.01; }, [](double t) { return t < 0.5 ? 0.0 : 0.01; });
  const auto f =
      force_N({{"sensor_bias", {0.3}}, {"time_delay", {0.02}}}, m, {{0.0, 0.05, 0.0, 1000.0, 0.0}});
  EXPECT_NEAR(f[0], 0.3, 1e-12);
  EXPECT_NEAR(f[50], 0.3, 1e-12);
  EXPECT_NEAR(f[53], 10.3, 1e-12);
}

TEST(Direction, HasNoneBelowTheSpeedThatCountsAsRest) {
  EXPECT_EQ(effects::direction(9e-6, 1e-5), 0.0);
  EXPECT_EQ(effects::direction(-9e-6, 1e-5), 0.0);
  EXPECT_NEAR(effects::direction(-1.5e-5, 1e-5), -0.5, 1e-12);
  EXPECT_EQ(effects::direction(2e-5, 1e-5), 1.0);
  EXPECT_EQ(effects::direction(1e-300, 0.0), 1.0);
  EXPECT_EQ(effects::direction(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace models
}  // namespace tractus
