#include "models/probing_runtime.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace models {
namespace {

/// One layer, K = 4000 N/m, D = 2000 N·s/m, x0 = 0.
ProbingModel one_layer() {
  ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.0}};
  return model;
}

ProbingForces predicted(const ProbingModel& model, const ProbingMotion& motion) {
  const auto runtime = ProbingRuntime::make(model, 0.05);
  EXPECT_TRUE(runtime) << runtime.error().what;
  ProbingForces forces;
  runtime->predict(motion, forces);
  return forces;
}

ProbingMotion three_moments() {
  return {.t_s = {0.0, 1e-3, 2e-3},
          .x_m = {0.010, 0.010, 0.010},
          .v_m_s = {0.005, 0.0, -0.005},
          .a_m_s2 = {0.0, 0.0, 0.0},
          .theta_rad = {},
          .omega_rad_s = {},
          .tz_Nm = {}};
}

TEST(ProbingRuntime, GivesOnlyTheOutputThatIsAskedFor) {
  ProbingMotion motion = three_moments();
  motion.theta_rad = {0.0, 0.1, 0.2}, motion.omega_rad_s = {1.0, 1.0, 1.0};
  const auto runtime = ProbingRuntime::make(one_layer(), 0.05);
  ASSERT_TRUE(runtime);
  ProbingForces both, force, torque;
  runtime->predict(motion, both);
  runtime->predict(motion, force, ProbingOutput::force);
  runtime->predict(motion, torque, ProbingOutput::torque);
  ASSERT_EQ(both.tz_Nm.size(), 3u);
  EXPECT_EQ(force.fz_N, both.fz_N);
  EXPECT_TRUE(force.tz_Nm.empty());
  EXPECT_EQ(torque.tz_Nm, both.tz_Nm);
  EXPECT_TRUE(torque.fz_N.empty());
}

TEST(ProbingRuntime, AddsFrictionAgainstTheMotionAndTheSensorsBias) {
  ProbingModel model = one_layer();
  model.effects = {{"sensor_bias", {0.25}}, {"coulomb_friction", {2.0}}};
  const auto forces = predicted(model, three_moments());
  // 4000 · 0.01 = 40 N; ± 2000 · 0.005 = 10 N and ± 2 N; + 0.25 N.
  ASSERT_EQ(forces.fz_N.size(), 3u);
  EXPECT_NEAR(forces.fz_N[0], 52.25, 1e-12);
  EXPECT_NEAR(forces.fz_N[1], 40.25, 1e-12);
  EXPECT_NEAR(forces.fz_N[2], 28.25, 1e-12);
  EXPECT_TRUE(forces.tz_Nm.empty());
}

constexpr double kTurning = 0.5;  // rad/s, above 10 °/s

ProbingRuntime live_runtime(std::vector<effects::EffectInstance> uses,
                            ProbingModel model = one_layer()) {
  model.effects = std::move(uses);
  auto runtime = ProbingRuntime::make(model, 0.05);
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

TEST(ProbingRuntime, IsTheLawLiveWhenItHasNoEffects) {
  const auto runtime = live_runtime({});
  ProbingLive live;
  laws::ProbingState state;
  for (int k = 0; k < 500; ++k) {
    const double push = 60.0 + 20.0 * std::sin(0.01 * k);
    const double v = runtime.advance(push, kTurning, 1e-3, live);
    EXPECT_EQ(v, runtime.law().advance(push, kTurning, 1e-3, state));
  }
  EXPECT_EQ(live.at.x_m, state.x_m);
  EXPECT_NEAR(live.t_s, 0.5, 1e-12);
}

TEST(ProbingRuntime, RestsUntilThePushBreaksTheFriction) {
  // Spring 4000 · 0.005 = 20 N, friction 6 N: at rest from 14 to 26 N.
  const auto runtime = live_runtime({{"coulomb_friction", {6.0}}});
  for (const double push : {14.001, 20.0, 25.999}) {
    ProbingLive live{.at = {.x_m = 0.005}};
    EXPECT_EQ(runtime.advance(push, kTurning, 1e-3, live), 0.0) << push;
    EXPECT_EQ(live.at.x_m, 0.005);
  }
  // Implicitly: v = (F ∓ F_c − K x)/(D + K dt) = ±2/(2000 + 4).
  ProbingLive in{.at = {.x_m = 0.005}}, out{.at = {.x_m = 0.005}};
  EXPECT_NEAR(runtime.advance(28.0, kTurning, 1e-3, in), 2.0 / 2004.0, 1e-12);
  EXPECT_NEAR(runtime.advance(12.0, kTurning, 1e-3, out), -2.0 / 2004.0, 1e-12);
}

TEST(ProbingRuntime, HoldsWhileTheProbeDoesNotTurnAndGoesOnRelaxing) {
  const auto runtime = live_runtime({{"viscoelastic_relaxation", {2000.0, 0.1}}});
  ProbingLive live{.at = {.x_m = 0.005}};
  for (int k = 0; k < 100; ++k) runtime.advance(80.0, kTurning, 1e-3, live);
  const double depth_m = live.at.x_m;
  const auto before = live;
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(runtime.advance(80.0, 0.1, 1e-3, live), 0.0);
  EXPECT_EQ(live.at.x_m, depth_m);
  EXPECT_EQ(live.at.mode, laws::ProbingMode::holding);
  // Ten time constants later the branch pushes back no more: the probe starts faster than it was.
  ProbingLive rested = live, tense = before;
  EXPECT_GT(runtime.advance(80.0, kTurning, 1e-3, rested),
            runtime.advance(80.0, kTurning, 1e-3, tense) + 1e-3);
}

TEST(ProbingRuntime, KeepsTheFasterOfTwoSpeedsWhileItMoves) {
  // Friction that falls from 30 to 2 N within some mm/s, D = 200 N·s/m, no spring: at 20 N both
  // rest and (20 − 2)/200 = 90 mm/s are in balance. From rest it stays, moving it goes on.
  ProbingModel model;
  model.layers = {{0.0, 0.05, 0.0, 200.0, 0.0}};
  const auto runtime = live_runtime({{"stribeck_friction", {2.0, 30.0, 0.004}}}, model);
  ProbingLive rest{.at = {.x_m = 0.005}}, moving{.at = {.x_m = 0.005}, .v_m_s = 0.08};
  EXPECT_EQ(runtime.advance(20.0, kTurning, 1e-3, rest), 0.0);
  EXPECT_NEAR(runtime.advance(20.0, kTurning, 1e-3, moving), 0.09, 1e-9);
  EXPECT_GT(runtime.advance(30.5, kTurning, 1e-3, rest), 0.1);  // breaks loose
}

TEST(ProbingRuntime, GoesThroughABreachAndToTheStopAsTheLawDoes) {
  laws::ProbingParameters parameters{
      .layers = {{0.0, 0.02, 4000.0, 2000.0, 0.0}, {0.02, 0.03, 1000.0, 4000.0, 0.01}},
      .walls = {{0.03, 0.004, 100.0, 0.005, 400.0}},
      .rotary = {},
      .travel_m = 0.05};
  const std::vector<effects::EffectInstance> nearly_nothing{{"inertia", {1e-9}}};
  const auto with = ProbingRuntime::make(parameters, nearly_nothing);
  const auto law = ProbingRuntime::make(parameters, {});
  ASSERT_TRUE(with && law);
  ProbingLive a, b;
  bool breached = false;
  for (int k = 0; k < 8000; ++k) {
    with->advance(100.0, kTurning, 1e-3, a);
    law->advance(100.0, kTurning, 1e-3, b);
    ASSERT_NEAR(a.at.x_m, b.at.x_m, 5e-4) << k;  // two ticks at 0.23 m/s, in the breach
    breached = breached || a.at.mode == laws::ProbingMode::breach;
  }
  EXPECT_TRUE(breached);
  EXPECT_EQ(a.at.mode, laws::ProbingMode::stopped);
  EXPECT_EQ(a.at.x_m, 0.05);
  for (int k = 0; k < 20000; ++k) with->advance(-60.0, kTurning, 1e-3, a);
  EXPECT_EQ(a.at.x_m, 0.0);  // and out again to the entry
}

TEST(ProbingRuntime, RefusesAnEffectByItsParameter) {
  ProbingModel model = one_layer();
  model.effects = {{"backlash", {1.0, 0.0}}};
  const auto wide = ProbingRuntime::make(model, 0.05);
  ASSERT_FALSE(wide);
  EXPECT_EQ(wide.error().what, "backlash/gap_m: 1 is outside 0 … 0.005");
  model.effects = {{"tip_ball", {0.001}}};
  EXPECT_EQ(ProbingRuntime::make(model, 0.05).error().what,
            "'tip_ball' is not an effect of the probing rig");
  model.effects = {{"inertia", {}}};
  EXPECT_EQ(ProbingRuntime::make(model, 0.05).error().what,
            "inertia: 0 numbers where 1 are expected");
}

}  // namespace
}  // namespace models
}  // namespace tractus
