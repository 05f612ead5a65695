/// What must hold of the probing law whatever its numbers: seeded random laws, walls included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "laws/probing_law.hpp"

namespace tractus {
namespace laws {
namespace {

constexpr double kTurning_rad_s = 0.5;
constexpr int kLaws = 60;

class EveryLaw : public testing::Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Two to six layers of 2 … 8 mm, one after the other, then perhaps a wall within R_i of bone.
  ProbingLaw any_law() {
    ProbingParameters p;
    p.travel_m = 0.06;
    double end_m = 0.0;
    const int layers = int(uniform(2.0, 7.0));
    for (int k = 0; k < layers; ++k) {
      const double thickness_m = uniform(0.002, 0.008);
      p.layers.push_back({end_m, thickness_m, uniform(0.0, 20000.0), uniform(500.0, 10000.0),
                          end_m - uniform(0.0, 0.004)});
      end_m += thickness_m;
    }
    if (uniform(0.0, 1.0) < 0.7) {
      const double before_m = uniform(0.0, 0.5 * end_m);
      p.walls.push_back(
          {end_m, before_m, uniform(0.0, 300.0), uniform(0.002, 0.01), uniform(100.0, 2000.0)});
    }
    p.layers.push_back({0.055, 0.005, 1000.0, 1000.0, 0.055});  // the probe stop is bone
    p.rotary = {uniform(0.0, 0.1), uniform(0.0, 0.05), uniform(0.05, 1.0)};
    auto law = ProbingLaw::make(std::move(p));
    EXPECT_TRUE(law) << law.error().what;
    return std::move(law).value();
  }
  std::mt19937_64 random_{20261121};
};

// In one dimension a force of the depth alone does no net work on a way that returns; the rest is
// D v² > 0. Stepped forth and back over the same points, so that the springs cancel exactly.
TEST_F(EveryLaw, TakesWorkOnEveryWayThatReturns) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    std::vector<double> way_m{0.0};
    while (way_m.size() < 400)
      way_m.push_back(std::clamp(way_m.back() + uniform(-0.0005, 0.0012), 0.0, 0.054));
    const double speed_m_s = uniform(1e-4, 0.1);
    double work_J = 0.0, springs_J = 0.0;
    for (std::size_t i = 1; i < way_m.size(); ++i) {
      const double step_m = way_m[i] - way_m[i - 1], middle_m = 0.5 * (way_m[i] + way_m[i - 1]);
      const double v = std::copysign(speed_m_s, step_m);
      work_J += law.force_N(middle_m, v) * step_m;
      work_J += law.force_N(middle_m, -v) * -step_m;  // and back
      springs_J += std::abs(law.force_N(middle_m, 0.0) * step_m);
    }
    EXPECT_GE(work_J, -1e-12 * springs_J);
  }
}

TEST_F(EveryLaw, ForceIsContinuousWithinALayerAndOnlyThere) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    const auto& p = law.parameters();
    for (const Layer& layer : p.layers)
      for (int i = 1; i < 50; ++i) {
        const double x_m = layer.start_m + layer.thickness_m * i / 50.0;
        const bool inside = law.mode_at(x_m) != ProbingMode::breach &&
                            law.mode_at(x_m - 1e-9) == law.mode_at(x_m + 1e-9);
        if (!inside) continue;
        // The slope of K (x − x0) + D v times what it grew to, over 2 nm.
        const double before = law.force_N(x_m - 1e-9, 0.005),
                     after = law.force_N(x_m + 1e-9, 0.005);
        EXPECT_NEAR(before, after, 1e-2);
      }
  }
}

TEST_F(EveryLaw, ResistanceDropsAtOnceAtAWall) {
  int walls = 0;
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    for (const CorticalWall& wall : law.parameters().walls) {
      ++walls;
      const double v = 0.01, before = law.force_N(wall.position_m - 1e-9, v),
                   after = law.force_N(wall.position_m + 1e-9, v);
      EXPECT_DOUBLE_EQ(after, wall.breach_damping_Ns_per_m * v);  // eq. (3), whatever was before
      EXPECT_EQ(law.mode_at(wall.position_m + 1e-9), ProbingMode::breach);
      EXPECT_EQ(law.torque_Nm(wall.position_m + 1e-9, 0.1, 1.0), 0.0);
      EXPECT_NE(before, after);
    }
  }
  EXPECT_GT(walls, kLaws / 2);
}

TEST_F(EveryLaw, DepthNeverMovesFasterThanTheActuatorAndStaysWithinTheTravel) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    ProbingState state;
    for (int i = 0; i < 3000; ++i) {
      const double before_m = state.x_m;
      law.advance(uniform(-50.0, 180.0), kTurning_rad_s, 1e-3, state);
      EXPECT_LE(std::abs(state.x_m - before_m), 0.23e-3 * (1.0 + 1e-9));
      EXPECT_GE(state.x_m, 0.0);
      EXPECT_LE(state.x_m, 0.06);
    }
  }
}

// The midpoint rule, cut at every border, is of second order in λ dt, λ = K/D up to 40 / s here:
// the two may not differ by what the stage can show, one step of its motor, 5 µm. The push is held
// over each millisecond for both.
TEST_F(EveryLaw, AnswersTheSameAtOneAndTenKilohertz) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    ProbingState slow, fast;
    double worst_m = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const double push_N = 90.0 + 60.0 * std::sin(0.01 * i);
      law.advance(push_N, kTurning_rad_s, 1e-3, slow);
      for (int j = 0; j < 10; ++j) law.advance(push_N, kTurning_rad_s, 1e-4, fast);
      worst_m = std::max(worst_m, std::abs(slow.x_m - fast.x_m));
    }
    EXPECT_LT(worst_m, 5e-6);
  }
}

TEST_F(EveryLaw, MotionFromForceGivesTheForceBack) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    for (int i = 0; i < 100; ++i) {
      const double x_m = uniform(0.0, 0.054), push_N = uniform(0.0, 150.0);
      ProbingState state{x_m, ProbingMode::bone};
      const double v = law.advance(push_N, kTurning_rad_s, 1e-7, state);
      if (std::abs(v) > 0.229 || law.mode_at(x_m) != law.mode_at(state.x_m)) continue;
      // Over 0.1 µs the depth is as good as still; a border or bare travel within is left out.
      const double given_N = law.force_N(0.5 * (x_m + state.x_m), v);
      if (given_N == 0.0) continue;
      EXPECT_NEAR(given_N, push_N, 0.02 + 1e-3 * push_N);
    }
  }
}

TEST_F(EveryLaw, TheRotaryStageTakesWorkOnEveryTurnThatReturns) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    const double viscous = law.parameters().rotary.viscous_Nms_per_rad;
    double work_J = 0.0, expected_J = 0.0, theta_rad = 0.0;
    std::vector<double> steps_rad;
    for (int i = 0; i < 200; ++i) steps_rad.push_back(uniform(-0.3, 0.3));
    const double omega = uniform(0.2, 5.0);
    const auto go = [&](double step_rad) {  // in small pieces, midpoint rule
      for (int piece = 0; piece < 20; ++piece) {
        const double d = step_rad / 20.0, v = std::copysign(omega, d);
        work_J += law.torque_Nm(0.001, theta_rad + 0.5 * d, v) * d;
        expected_J += viscous * v * d;
        theta_rad += d;
      }
    };
    for (const double step : steps_rad) go(step);
    for (auto step = steps_rad.rbegin(); step != steps_rad.rend(); ++step) go(-*step);
    EXPECT_NEAR(work_J, expected_J, 1e-9);  // the detents give all back, the friction nothing
    EXPECT_GE(work_J, -1e-9);
  }
}

TEST_F(EveryLaw, TheDetentsTorqueIsSmoothHasTheirPitchAndPullsBack) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    const auto& r = law.parameters().rotary;
    for (int i = 0; i < 200; ++i) {
      const double theta = uniform(-20.0, 20.0);
      // By hand: T sin(2πθ/p).
      const double expected =
          r.detent_Nm * std::sin(2.0 * std::numbers::pi * theta / r.detent_pitch_rad);
      EXPECT_NEAR(law.torque_Nm(0.001, theta, 0.0), expected, 1e-9);
      EXPECT_NEAR(law.torque_Nm(0.001, theta + r.detent_pitch_rad, 0.0), expected, 1e-9);
      const RotaryGains g = law.rotary_gains(0.001, theta);
      EXPECT_GE(g.proportional_Nm_per_rad, -1e-12);  // towards the nearest detent, never away
      EXPECT_LE(std::abs(g.from_detent_rad), 0.5 * r.detent_pitch_rad * (1.0 + 1e-12));
    }
    const double midway = 2.5 * r.detent_pitch_rad;  // where the nearest detent changes
    EXPECT_NEAR(law.torque_Nm(0.001, midway - 1e-9, 0.0), law.torque_Nm(0.001, midway + 1e-9, 0.0),
                1e-6);
  }
}

TEST_F(EveryLaw, TurningFromTorqueGivesTheTorqueBack) {
  for (int k = 0; k < kLaws; ++k) {
    const ProbingLaw law = any_law();
    for (int i = 0; i < 50; ++i) {
      const double theta = uniform(-5.0, 5.0), torque = uniform(-0.5, 0.5);
      const double omega = law.turning_rad_s(0.001, theta, torque);
      EXPECT_LE(std::abs(omega), ProbingLaw::kFreeTurning_rad_s);
      if (std::abs(omega) == ProbingLaw::kFreeTurning_rad_s) continue;
      EXPECT_NEAR(law.torque_Nm(0.001, theta, omega), torque, 1e-9);
    }
  }
}

}  // namespace
}  // namespace laws
}  // namespace tractus
