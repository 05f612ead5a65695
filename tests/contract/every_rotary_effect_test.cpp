/// What every effect about the axis keeps to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/probing_runtime.hpp"
#include "station/loop/allocation_guard.hpp"

namespace tractus {
namespace {

using effects::Kind;
using effects::ProbingEffectInfo;
using models::ProbingForces;
using models::ProbingLive;
using models::ProbingMotion;
using models::ProbingRuntime;

constexpr double kRotaryTravel_m = 0.05, kWall_m = 0.02;

/// Bone to 50 mm, a wall at 20 mm with 5 mm of soft tissue behind it.
laws::ProbingParameters rotary_bone() {
  return {.layers = {{0.0, kRotaryTravel_m, 4000.0, 2000.0, 0.0}},
          .walls = {{kWall_m, 0.002, 10.0, 0.005, 500.0}},
          .rotary = {},
          .travel_m = kRotaryTravel_m};
}

/// One turn to and fro in 2 s at a depth that stays: θ = 0.5 sin(π t).
ProbingMotion turning(double rate_Hz, double length_s, double x_m = 0.01) {
  ProbingMotion m{.rest_m_s = 0.0, .rest_rad_s = 0.0};
  const double w = std::numbers::pi;
  const auto n = std::size_t(std::lround(rate_Hz * length_s)) + 1;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = double(k) / rate_Hz;
    m.t_s.push_back(t);
    m.x_m.push_back(x_m);
    m.v_m_s.push_back(0.0);
    m.a_m_s2.push_back(0.0);
    m.theta_rad.push_back(0.5 * std::sin(w * t));
    m.omega_rad_s.push_back(0.5 * w * std::cos(w * t));
  }
  return m;
}

class EveryRotaryEffect : public testing::TestWithParam<std::string> {
 protected:
  static const ProbingEffectInfo& entry(const std::string& id) {
    return *std::ranges::find(effects::probing_effects(), id,
                              [](const auto& info) { return info.facts.id; });
  }
  enum class At { off, initial, high };
  ProbingRuntime with(At at) const {
    effects::EffectInstance use{info_.facts.id, {}};
    for (const auto& p : info_.facts.params)
      use.values.push_back(at == At::off ? p.off : at == At::initial ? p.initial : p.high);
    auto made = ProbingRuntime::make(rotary_bone(), std::vector{use});
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }
  static ProbingRuntime without() {
    auto made = ProbingRuntime::make(rotary_bone(), {});
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }
  static ProbingForces predicted(const ProbingRuntime& runtime, const ProbingMotion& motion) {
    ProbingForces out;
    runtime.predict(motion, out);
    return out;
  }
  const ProbingEffectInfo& info_ = entry(GetParam());
  const bool measures_ = info_.facts.kind == Kind::measurement;
};

TEST_P(EveryRotaryEffect, IsNothingWhenOff) {
  const auto motion = turning(1000.0, 4.0);
  EXPECT_EQ(predicted(with(At::off), motion).tz_Nm, predicted(without(), motion).tz_Nm);
}

TEST_P(EveryRotaryEffect, ChangesTheTorqueAndNeverTheForce) {
  const auto motion = turning(1000.0, 4.0);
  const auto one = predicted(with(At::initial), motion), none = predicted(without(), motion);
  EXPECT_EQ(one.fz_N, none.fz_N);
  double most = 0.0;
  for (std::size_t k = 0; k < one.tz_Nm.size(); ++k)
    most = std::max(most, std::abs(one.tz_Nm[k] - none.tz_Nm[k]));
  EXPECT_GT(most, 0.001);  // the sensor's floor, N·m
}

TEST_P(EveryRotaryEffect, IsFeltLiveUnlessItBelongsToTheSensor) {
  const double felt_Nm = with(At::initial).torque_Nm(0.01, 0.3, 1.0),
               plain_Nm = without().torque_Nm(0.01, 0.3, 1.0);
  if (measures_)
    EXPECT_EQ(felt_Nm, plain_Nm);
  else
    EXPECT_GT(std::abs(felt_Nm - plain_Nm), 0.001);
}

TEST_P(EveryRotaryEffect, LeavesTheMotionAlongTheProbeAsItIs) {
  const auto effect = with(At::high), plain = without();
  ProbingLive a{.at = {.x_m = 0.005}}, b{.at = {.x_m = 0.005}};
  for (int k = 0; k < 500; ++k) {
    effect.advance(40.0, 1.0, 1e-3, a);
    plain.advance(40.0, 1.0, 1e-3, b);
  }
  EXPECT_EQ(a.at.x_m, b.at.x_m);
}

/// The motor that renders it is off there.
TEST_P(EveryRotaryEffect, IsNotFeltBehindAWall) {
  EXPECT_EQ(with(At::high).torque_Nm(kWall_m + 0.002, 0.3, 1.0), 0.0);
}

TEST_P(EveryRotaryEffect, DoesNotChatterAtRest) {
  const auto runtime = with(At::initial);
  double before_Nm = runtime.torque_Nm(0.01, 0.0, -0.02);
  for (double omega = -0.02; omega < 0.02; omega += 1e-4) {
    const double now_Nm = runtime.torque_Nm(0.01, 0.0, omega);
    EXPECT_LT(std::abs(now_Nm - before_Nm), 1e-4) << omega;  // N·m in a step of 0.1 mrad/s
    before_Nm = now_Nm;
  }
}

TEST_P(EveryRotaryEffect, AllocatesNothingInATick) {
  const auto runtime = with(At::high);
  const loop::AllocationGuard guard;
  double sum_Nm = 0.0;
  for (int k = 0; k < 1000; ++k) sum_Nm += runtime.torque_Nm(0.01, 1e-3 * k, 1.0);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(std::isfinite(sum_Nm));
}

TEST_P(EveryRotaryEffect, GivesBackNoMoreWorkThanItGot) {
  if (measures_) return;
  const auto motion = turning(4000.0, 4.0);
  const auto with_Nm = predicted(with(At::initial), motion).tz_Nm,
             plain_Nm = predicted(without(), motion).tz_Nm;
  double work_J = 0.0;  // of the hand against the effect, over two whole turns to and fro
  for (std::size_t k = 1; k < motion.size(); ++k) {
    const double mean_Nm = 0.5 * (with_Nm[k] - plain_Nm[k] + with_Nm[k - 1] - plain_Nm[k - 1]);
    work_J += mean_Nm * (motion.theta_rad[k] - motion.theta_rad[k - 1]);
  }
  EXPECT_GT(work_J, -1e-9);
}

std::vector<std::string> rotary_ids() {
  std::vector<std::string> out;
  for (const auto& info : effects::probing_effects())
    if (info.facts.channel == effects::Channel::torque) out.push_back(info.facts.id);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Probing, EveryRotaryEffect, testing::ValuesIn(rotary_ids()),
                         [](const auto& one) { return one.param; });

// By hand: 0.05 N·m of friction and a spring of 0.2 N·m/rad at θ = 0.3 rad, turning on:
// 0.05 + 0.06 = 0.11 N·m; turning back: −0.05 + 0.06 = 0.01 N·m.
TEST(RotaryEffects, AddUpAsByHand) {
  laws::ProbingParameters free{.layers = {},
                               .walls = {},
                               .rotary = {.viscous_Nms_per_rad = 0.0, .detent_Nm = 0.0},
                               .travel_m = kRotaryTravel_m};
  const auto runtime = ProbingRuntime::make(
      free, std::vector<effects::EffectInstance>{{"rotary_coulomb_friction", {0.05}},
                                                 {"rotary_stiffness", {0.2}}});
  ASSERT_TRUE(runtime) << runtime.error().what;
  EXPECT_NEAR(runtime->torque_Nm(0.0, 0.3, 1.0), 0.11, 1e-12);
  EXPECT_NEAR(runtime->torque_Nm(0.0, 0.3, -1.0), 0.01, 1e-12);
}

}  // namespace
}  // namespace tractus
