/// Moment by moment as over the whole motion.
#include "models/probing_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace models {
namespace {

constexpr double kStart_s = 2.0, kSpacing_s = 1e-3;

/// In and out through two layers with pauses, turning, with a recorded torque: 3 s at 1 kHz.
ProbingMotion strokes() {
  ProbingMotion m{.rest_m_s = 2e-4, .rest_rad_s = 1e-2};
  for (int k = 0; k < 3000; ++k) {
    const double t = kSpacing_s * k, w = 4.0;
    m.t_s.push_back(kStart_s + t);
    m.x_m.push_back(0.010 - 0.008 * std::cos(w * t));
    m.v_m_s.push_back(0.008 * w * std::sin(w * t));
    m.a_m_s2.push_back(0.008 * w * w * std::cos(w * t));
    m.theta_rad.push_back(std::sin(2.0 * t));
    m.omega_rad_s.push_back(2.0 * std::cos(2.0 * t));
    m.tz_Nm.push_back(0.05 * std::sin(3.0 * t));
  }
  return m;
}

effects::ProbingTick moment(const ProbingMotion& m, std::size_t k) {
  return {.t_s = m.t_s[k],
          .x_m = m.x_m[k],
          .v_m_s = m.v_m_s[k],
          .a_m_s2 = m.a_m_s2[k],
          .theta_rad = m.theta_rad[k],
          .omega_rad_s = m.omega_rad_s[k],
          .tz_Nm = m.tz_Nm[k],
          .rest_m_s = m.rest_m_s,
          .rest_rad_s = m.rest_rad_s};
}

ProbingRuntime two_layers(std::vector<effects::EffectInstance> uses) {
  ProbingModel model;
  model.layers = {{0.0, 0.008, 900.0, 300.0, 0.0}, {0.008, 0.03, 2500.0, 700.0, 0.002}};
  model.effects = std::move(uses);
  auto runtime = ProbingRuntime::make(model, 0.1);
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

/// Largest difference between the two ways, of force and torque together.
double difference(const ProbingRuntime& runtime, const ProbingMotion& motion) {
  ProbingForces whole;
  runtime.predict(motion, whole);
  ProbingStream stream(runtime, motion.t_s.front(), motion.t_s.back());
  double most = 0.0;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const auto asked = stream.at(moment(motion, k)), kept = stream.keep(moment(motion, k));
    EXPECT_EQ(asked.fz_N, kept.fz_N);  // who asks moves nothing
    most = std::max(
        {most, std::abs(kept.fz_N - whole.fz_N[k]), std::abs(kept.tz_Nm - whole.tz_Nm[k])});
  }
  return most;
}

TEST(ProbingStream, AnswersAsThePredictionOverTheWholeMotionWithEachEffect) {
  const ProbingMotion motion = strokes();
  for (const auto& info : effects::probing_effects()) {
    effects::EffectInstance use{info.facts.id, {}};
    for (const auto& p : info.facts.params)
      use.values.insert(use.values.end(), std::size_t(p.components), p.initial);
    EXPECT_LT(difference(two_layers({use}), motion), 1e-11) << use.id;
  }
}

TEST(ProbingStream, AnswersSoWithManyEffectsAtOnce) {
  EXPECT_LT(difference(two_layers({{"backlash", {3e-4, 1.0}},
                                   {"hysteresis", {1e4, 1e-4}},
                                   {"viscoelastic_relaxation", {500.0, 0.5}},
                                   {"rotation_coupling", {0.1}},
                                   {"bouc_wen", {5e3, 2e-4, 0.5}},
                                   {"stribeck_friction", {1.0, 2.0, 4e-3}},
                                   {"time_delay", {0.0123}},
                                   {"sensor_drift", {0.5}},
                                   {"torque_crosstalk", {5.0}},
                                   {"rotary_coulomb_friction", {0.01}}}),
                       strokes()),
            1e-11);
}

TEST(ProbingStream, ForgetsNothingThatALongDelayReaches) {
  EXPECT_LT(difference(two_layers({{"time_delay", {0.2}}}), strokes()), 1e-11);
}

TEST(ProbingStream, GoesStraightOnFromTheLastTwoMomentsInADelayShorterThanAStep) {
  // No layer, 1 kg, a = t²: F = t², and F(t − 0.4 ms) between the samples at 1 and 2 ms. With the slope of the
  // one interval at its end and, at its beginning, that of two: Hermite at u = 0.6,
  // 1 + 0.6·(3 + 0.4·(0.4·(2 − 3) + 0.6·(3 − 3))) = 2.704 in units of (1 ms)².
  ProbingModel model;
  model.effects = {{"inertia", {1.0}}, {"time_delay", {0.4e-3}}};
  const auto runtime = ProbingRuntime::make(model, 0.1);
  ASSERT_TRUE(runtime);
  ProbingStream stream(*runtime, 0.0, 1.0);
  double last_N = 0.0;
  for (int k = 0; k <= 2; ++k) last_N = stream.keep({.t_s = 1e-3 * k, .a_m_s2 = 1e-6 * k * k}).fz_N;
  EXPECT_NEAR(last_N, 2.704e-6, 1e-15);
}

TEST(ProbingStream, ACopyGoesOnFromWhereTheOriginalStands) {
  const auto runtime = two_layers({{"hysteresis", {1e4, 1e-4}}, {"time_delay", {0.01}}});
  const ProbingMotion motion = strokes();
  ProbingStream one(runtime, motion.t_s.front(), motion.t_s.back());
  for (std::size_t k = 0; k < 1000; ++k) one.keep(moment(motion, k));
  ProbingStream two = one;
  std::vector<double> first_N;
  for (std::size_t k = 1000; k < 2000; ++k) first_N.push_back(one.keep(moment(motion, k)).fz_N);
  for (std::size_t k = 1000; k < 2000; ++k)
    ASSERT_EQ(two.keep(moment(motion, k)).fz_N, first_N[k - 1000]) << k;
}

}  // namespace
}  // namespace models
}  // namespace tractus
