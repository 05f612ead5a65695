#include "laws/probing_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace laws {
namespace {

constexpr double kTurning = 0.5;  // rad/s, above 10 °/s = 0.1745 rad/s

ProbingParameters one_layer() {
  ProbingParameters p;
  p.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.0}};
  p.travel_m = 0.05;
  return p;
}

ProbingParameters with_breach() {
  ProbingParameters p = one_layer();
  p.walls = {{0.03, 0.005, 200.0, 0.01, 400.0}};
  return p;
}

ProbingLaw law_of(ProbingParameters p) {
  auto law = ProbingLaw::make(std::move(p));
  EXPECT_TRUE(law) << law.error().what;
  return std::move(law).value();
}

TEST(ProbingLaw, FollowsTheExponentialOfEquationTwoUnderAConstantPush) {
  // x(t) = F/K (1 − exp(−K t / D)): F = 80 N, K = 4000 N/m, D = 2000 N·s/m, t = 0.5 s → 0.02 (1 −
  // e⁻¹) = 0.0126424 m.
  const auto law = law_of(one_layer());
  ProbingState state;
  for (int k = 0; k < 500; ++k) law.advance(80.0, kTurning, 1e-3, state);
  EXPECT_NEAR(state.x_m, 0.0126424112, 1e-8);
  EXPECT_EQ(state.mode, ProbingMode::bone);
}

TEST(ProbingLaw, HoldsUntilTheProbeTurnsFasterThanTenDegreesASecond) {
  const auto law = law_of(one_layer());
  ProbingState state;
  EXPECT_EQ(law.advance(100.0, 0.17, 1e-3, state), 0.0);
  EXPECT_EQ(state.mode, ProbingMode::holding);
  EXPECT_GT(law.advance(100.0, -0.18, 1e-3, state), 0.0);  // either sense of turning
}

TEST(ProbingLaw, GrowsLinearlyBeforeTheWallAndDropsBehindIt) {
  const auto law = law_of(with_breach());
  // At 25 mm the interval begins: no jump. 4 mm into it: 1 + 200 · 0.004 = 1.8.
  EXPECT_NEAR(law.force_N(0.025 - 1e-9, 0.004), law.force_N(0.025 + 1e-9, 0.004), 1e-3);
  EXPECT_NEAR(law.force_N(0.029, 0.0), 1.8 * 4000.0 * 0.029, 1e-9);
  EXPECT_NEAR(law.force_N(0.029, 0.004), 1.8 * (4000.0 * 0.029 + 2000.0 * 0.004), 1e-9);
  // Behind it only D_b v: 400 · 0.004 = 1.6 N, from (2 · 128 N) just before.
  EXPECT_NEAR(law.force_N(0.031, 0.004), 1.6, 1e-12);
  EXPECT_EQ(law.mode_at(0.031), ProbingMode::breach);
  EXPECT_EQ(law.torque_Nm(0.031, 0.1, 2.0), 0.0);
  EXPECT_NEAR(law.torque_Nm(0.01, 0.0875, 2.0), 0.02 * 2.0 + 0.01,
              1e-12);  // a quarter of the detent pitch
}

TEST(ProbingLaw, ReturnsIntoBoneBehindTheBreach) {
  const auto law = law_of(with_breach());
  EXPECT_EQ(law.mode_at(0.0405), ProbingMode::bone);
  EXPECT_NEAR(law.force_N(0.0405, 0.0), 4000.0 * 0.0405, 1e-9);
}

TEST(ProbingLaw, MotionAndForceAreInverseOfOneAnother) {
  const auto law = law_of(with_breach());
  for (const double x : {0.001, 0.02, 0.027, 0.033, 0.045}) {
    ProbingState state{x, ProbingMode::bone};
    const double push = law.mode_at(x) == ProbingMode::breach
                            ? 80.0
                            : 210.0;  // 210 N would pass the actuator's speed there
    const double v = law.advance(push, kTurning, 1e-7, state);
    ASSERT_GT(v, 0.0);
    ASSERT_LT(v, 0.23);
    EXPECT_NEAR(law.force_N(x, v), push, 0.02) << x;
  }
}

TEST(ProbingLaw, GivesTheSameMotionAtOneAndTenKilohertz) {
  // The midpoint rule is of second order: from 1 kHz to 10 kHz the error falls to about 1/100 of
  // its own size.
  const auto law = law_of(with_breach());
  const auto depth_after = [&](double dt) {
    ProbingState state;
    const int ticks = static_cast<int>(std::lround(0.4 / dt));
    for (int k = 0; k < ticks; ++k)
      law.advance(230.0 + 20.0 * std::sin(8.0 * k * dt), kTurning, dt, state);
    return state.x_m;
  };
  const double finest = depth_after(1e-5);
  EXPECT_NEAR(depth_after(1e-3), finest, 1e-4);
  EXPECT_LT(std::abs(depth_after(1e-4) - finest),
            0.2 * std::abs(depth_after(1e-3) - finest) + 1e-7);
}

TEST(ProbingLaw, IsPassiveWhereTheSpringIsAtItsEquilibrium) {
  // Pushing in and letting the spring push back: the hand never gets more work than it gave (K, D
  // >= 0, one layer).
  const auto law = law_of(one_layer());
  ProbingState state;
  double work_J = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double F = 60.0 * std::sin(2.0 * k * 1e-3);
    const double before = state.x_m;
    law.advance(F, kTurning, 1e-3, state);
    work_J += F * (state.x_m - before);
    EXPECT_GE(work_J, -1e-6) << k;
  }
}

TEST(ProbingLaw, StopsAtTheProbeStopAndNeverLeavesTheEntry) {
  const auto law = law_of(one_layer());
  ProbingState state{0.0499, ProbingMode::bone};
  for (int k = 0; k < 100; ++k) law.advance(5000.0, kTurning, 1e-3, state);
  EXPECT_EQ(state.x_m, 0.05);
  EXPECT_EQ(state.mode, ProbingMode::stopped);
  state.x_m = 1e-6;
  for (int k = 0; k < 100; ++k) law.advance(-500.0, kTurning, 1e-3, state);
  EXPECT_EQ(state.x_m, 0.0);
}

TEST(ProbingLaw, RefusesByNameWhatCannotBe) {
  const auto refusal = [](auto change) {
    ProbingParameters p = with_breach();
    change(p);
    auto law = ProbingLaw::make(p);
    return law ? std::string("accepted") : law.error().what;
  };
  EXPECT_NE(refusal([](auto& p) {
              p.layers[0].stiffness_N_per_m = -1;
            }).find("layers/0/stiffness_N_per_m"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& p) {
              p.layers[0].stiffness_N_per_m = 1e9;
            }).find("layers/0/stiffness_N_per_m"),
            std::string::npos);
  EXPECT_NE(refusal([](auto& p) {
              p.layers.push_back({0.04, 0.005, 1, 1, 0});
            }).find("layers/1/start_m"),
            std::string::npos);
  EXPECT_NE(
      refusal([](auto& p) { p.walls[0].breach_interval_m = 0.03; }).find("walls/0/position_m"),
      std::string::npos);
  EXPECT_NE(refusal([](auto& p) {
              p.layers[0].damping_Ns_per_m = std::nan("");
            }).find("layers/0/damping_Ns_per_m"),
            std::string::npos);
}

}  // namespace
}  // namespace laws
}  // namespace tractus
