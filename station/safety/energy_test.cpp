#include "station/safety/energy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tractus {
namespace safety {
namespace {
using math::Vec3;

math::Pose at(double x_m) { return {{x_m, 0, 0}, math::Quat::Identity()}; }

TEST(EnergyObserver, CountsTheWorkOfTheHeldForceOverTheWay) {
  EnergyObserver energy;
  energy.moved_to(at(0.0));
  energy.holds({{2.0, 5.0, 0.0}, Vec3::Zero()});
  energy.moved_to(at(0.01));  // 2 N over 10 mm; nothing moved along y
  EXPECT_NEAR(energy.given_J(), 0.02, 1e-15);
  energy.holds({{-1.0, 0, 0}, Vec3::Zero()});
  energy.moved_to(at(0.04));
  EXPECT_NEAR(energy.given_J(), -0.01, 1e-15);
  EXPECT_NEAR(energy.injected_J(), 0.02, 1e-15);  // the highest
}

TEST(EnergyObserver, CountsTheWorkOfTheHeldTorqueOverTheTurn) {
  EnergyObserver energy;
  energy.moved_to({});
  energy.holds({Vec3::Zero(), {0, 0, 0.1}});
  energy.moved_to({Vec3::Zero(), math::Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))});
  EXPECT_NEAR(energy.given_J(), 0.05, 1e-12);
}

// A sampled spring wall gives back more than it took: the force of the deepest sample is held on
// the way out. By hand: in by steps h to depth n h and out again, the excess is k h² n.
TEST(EnergyObserver, FindsWhatASampledWallInjects) {
  const double k = 1000.0, h = 1e-4;
  const int n = 20;
  EnergyObserver energy;
  double x = 0.0;
  const auto step = [&](double to) {
    energy.moved_to(at(to));
    energy.holds({{-k * to, 0, 0}, Vec3::Zero()});
    x = to;
  };
  step(0.0);
  for (int i = 1; i <= n; ++i) step(i * h);
  for (int i = n - 1; i >= 0; --i) step(i * h);
  EXPECT_NEAR(energy.given_J(), k * h * h * n, 1e-12);
  EXPECT_NEAR(energy.injected_J(), k * h * h * n, 1e-12);
}

TEST(EnergyObserver, DoesNotCountWhatItDidNotSee) {
  EnergyObserver energy;
  energy.moved_to(at(0.0));
  energy.holds({{2.0, 0, 0}, Vec3::Zero()});
  energy.lost_sight();
  energy.moved_to(at(1.0));
  EXPECT_EQ(energy.given_J(), 0.0);
}

TEST(PassivityController, LeavesAPassiveSurroundingAlone) {
  const math::Wrench wanted{{1, 2, 3}, {0.1, 0, 0}};
  const auto out = PassivityController::damped(wanted, -0.5, {0.1, 0, 0}, {1, 0, 0}, 2.5e-4);
  EXPECT_EQ(out.force_N, wanted.force_N);
  EXPECT_EQ(out.torque_Nm, wanted.torque_Nm);
}

TEST(PassivityController, DampsAgainstTheMotionAndNeverPushesAlongIt) {
  const Vec3 v(0.1, -0.05, 0.02), w(2, 0, 1);
  for (const double given_J : {3e-4, 1e-3, 1e-2, 1.0}) {
    const auto out = PassivityController::damped({}, given_J, v, w, 2.5e-4);
    EXPECT_LT(out.force_N.dot(v), 0.0);
    EXPECT_LE(out.torque_Nm.dot(w), 0.0);
    EXPECT_LE(out.force_N.norm(), PassivityController::kMost_Ns_per_m * v.norm() * (1 + 1e-12));
  }
}

/// A mass of 0.2 kg bouncing on a stiff wall that is sampled at 1 kHz, with and without.
double injected_by_a_bounce(bool controlled) {
  constexpr double kT = 1e-3, kWall = 8000.0, kMass = 0.2;
  EnergyObserver energy;
  double x = -0.002, v = 0.2;
  math::Wrench held;
  for (int tick = 0; tick < 2000; ++tick) {
    energy.moved_to(at(x));
    held = {{x > 0.0 ? -kWall * x : 0.0, 0, 0}, Vec3::Zero()};
    if (controlled)
      held = PassivityController::damped(held, energy.given_J(), {v, 0, 0}, Vec3::Zero(), kT);
    energy.holds(held);
    const double a = held.force_N.x() / kMass;  // exact for a held force
    x += v * kT + 0.5 * a * kT * kT;
    v += a * kT;
    if (x < -0.003) v = std::abs(v);  // a hand pushes it back
  }
  return energy.injected_J();
}

TEST(PassivityController, TakesBackMostOfWhatAStiffSampledWallInjects) {
  const double without = injected_by_a_bounce(false), with = injected_by_a_bounce(true);
  EXPECT_GT(without, 0.01);
  EXPECT_LT(with, 0.25 * without);
}

}  // namespace
}  // namespace safety
}  // namespace tractus
