#include "replay/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "replay/pictures.hpp"
#include "replay/table.hpp"

namespace tractus {
namespace replay {
namespace {

using math::Vec3;
using testing::HasSubstr;

/// A flat floor: opacity rises along +z over the middle of the block; the probe comes down on it
/// along −z.
volume::Volume floor_block() {
  volume::Volume block;
  block.geometry.dims = {24, 24, 40};
  block.geometry.spacing_m = Vec3::Constant(0.5e-3);
  block.counts.assign(block.geometry.voxel_count(), 0);
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) block.counts[block.offset(i, j, k)] = 1000;
  return block;
}

models::PalpationRuntime runtime(laws::PalpationParameters base = {}) {
  models::PalpationModel model;
  model.base = base;
  auto made = models::PalpationRuntime::make(model, floor_block());
  EXPECT_TRUE(made);
  return std::move(*made);
}

/// Down into the floor and up again, tip first, with a little tilt; times `rate_Hz` apart.
trial::PalpationMeasurement tap(double rate_Hz = 100.0, double seconds = 0.5) {
  trial::PalpationMeasurement out;
  out.id = "tap";
  out.file = "tap.csv";
  const math::Quat down(Eigen::AngleAxisd(M_PI - 0.1, Vec3::UnitX()));
  for (int k = 0; k <= int(std::lround(seconds * rate_Hz)); ++k) {
    const double t = k / rate_Hz, depth = 5.5e-3 * std::sin(M_PI * t / seconds);
    const Vec3 tip(6e-3, 6e-3, 15e-3 - depth);
    out.t_s.push_back(t);
    out.X_VH.push_back({tip - 0.13 * (down * Vec3::UnitZ()), down});
    out.wrench_H.push_back({Vec3(0.1, 0, -1), Vec3(0, 0.01, 0)});
  }
  return out;
}

TEST(Replay, StepsAtFourKilohertzAndAnswersAtTheRecordedTimes) {
  const auto model = runtime();
  const auto slow = replay(model, tap(100.0));
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->wrench_H.size(), 51u);
  EXPECT_EQ(slow->steps, 2001u);  // 0.5 s · 4000 Hz and the first
  const auto fast = replay(model, tap(4000.0));
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->steps, 2001u);
  const auto odd = replay(model, tap(150.0, 0.2));  // 1/150 s holds 26.7 steps: 27 of them
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->steps, 30u * 27u + 1u);
}

TEST(Replay, PushesTheProbeBackWhereItPressesAndNowhereElse) {
  const auto answer = replay(runtime(), tap());
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->wrench_H.front().force_N.norm(), 0.0);
  double lowest = 0.0;
  for (const auto& wrench : answer->wrench_H) lowest = std::min(lowest, wrench.force_N.z());
  EXPECT_LT(lowest, -0.1);  // z points to the tip: the bone pushes towards the handle
  EXPECT_EQ(answer->samples_in_volume, 51u);
}

TEST(Replay, ScalesForcesWithForceScaleAlone) {
  // s_f enters after the equilibrium, eq. (3): forces double, torques and deflections stay to the
  // bit.
  laws::PalpationParameters doubled;
  doubled.force_scale *= 2.0;
  const auto one = replay(runtime(), tap()), two = replay(runtime(doubled), tap());
  ASSERT_TRUE(one && two);
  for (std::size_t k = 0; k < one->wrench_H.size(); ++k) {
    EXPECT_EQ(two->wrench_H[k].force_N, 2.0 * one->wrench_H[k].force_N);
    EXPECT_EQ(two->wrench_H[k].torque_Nm, one->wrench_H[k].torque_Nm);
    EXPECT_EQ(two->deflection_m[k], one->deflection_m[k]);
  }
}

TEST(Replay, BendsTheSameWhenBoneAndShankAreBothTwiceAsStiff) {
  // k δ = Σ φ F: with c_f and E doubled δ stays and every force doubles. Both sides stop within 1
  // mN of rest.
  laws::PalpationParameters doubled;
  doubled.force_factor_Nm *= 2.0;
  doubled.youngs_modulus_Pa *= 2.0;
  const auto one = replay(runtime(), tap()), two = replay(runtime(doubled), tap());
  ASSERT_TRUE(one && two);
  for (std::size_t k = 0; k < one->wrench_H.size(); ++k) {
    EXPECT_NEAR((two->wrench_H[k].force_N - 2.0 * one->wrench_H[k].force_N).norm(), 0.0, 1e-5);
    EXPECT_NEAR((two->deflection_m[k] - one->deflection_m[k]).norm(), 0.0, 1e-7);
  }
}

TEST(Replay, GivesTheSameBitsTwiceAndUnderAShiftOfTime) {
  const auto model = runtime();
  auto later = tap();
  for (double& t : later.t_s)
    t += 1024.0;  // a power of two: the differences of times stay exact enough
  const auto one = replay(model, tap()), again = replay(model, tap()),
             shifted = replay(model, later);
  ASSERT_TRUE(one && again && shifted);
  for (std::size_t k = 0; k < one->wrench_H.size(); ++k) {
    EXPECT_EQ(one->wrench_H[k].force_N, again->wrench_H[k].force_N);
    EXPECT_NEAR((one->wrench_H[k].force_N - shifted->wrench_H[k].force_N).norm(), 0.0, 1e-6);
  }
}

TEST(Replay, TurnsWithTheHandleAboutItsAxis) {
  // H turned about its own z: the same force in V, so turned back in H.
  const math::Quat roll(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  auto rolled = tap();
  for (auto& pose : rolled.X_VH) pose.q = pose.q * roll;
  const auto model = runtime();
  const auto one = replay(model, tap()), two = replay(model, rolled);
  ASSERT_TRUE(one && two);
  for (std::size_t k = 0; k < one->wrench_H.size(); ++k)
    EXPECT_NEAR((roll * two->wrench_H[k].force_N - one->wrench_H[k].force_N).norm(), 0.0, 1e-5);
}

TEST(Replay, RefusesAGapInWhichTheMotionIsNotKnown) {
  auto recording = tap();
  for (std::size_t k = 30; k < recording.t_s.size(); ++k) recording.t_s[k] += 1.5;
  const auto answer = replay(runtime(), recording);
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().what, HasSubstr("tap.csv: no sample between 0.29 s and 1.8 s"));
}

TEST(Replay, StopsWhenAskedTo) {
  const auto answer = replay(runtime(), tap(4000.0), -Vec3::UnitZ(), [](double) { return false; });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, core::Errc::cancelled);
}

TEST(Table, CountsAmountsAboveTheFloorAlone) {
  // By hand: |F_z| of 0.005 stays out, 1 and 3 count: mean 2, sd √2 (n − 1), max 3; F_xy = hypot(3,
  // 4) = 5 once.
  const std::vector<math::Wrench> wrenches{{Vec3(0, 0, -1), Vec3::Zero()},
                                           {Vec3(3, 4, 3), Vec3(0, 0, 0.001)},
                                           {Vec3(0, 0, 0.005), Vec3(0.0006, 0.0008, 0)}};
  const Summary fz = summary(wrenches, kChannels[1]);
  EXPECT_EQ(fz.above, 2u);
  EXPECT_DOUBLE_EQ(fz.mean, 2.0);
  EXPECT_DOUBLE_EQ(fz.sd, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(fz.max, 3.0);
  const Summary fxy = summary(wrenches, kChannels[0]);
  EXPECT_EQ(fxy.above, 1u);
  EXPECT_DOUBLE_EQ(fxy.mean, 5.0);
  EXPECT_TRUE(std::isnan(fxy.sd));
  EXPECT_EQ(summary(wrenches, kChannels[3]).above, 0u);  // 0.001 is not above 0.001
}

TEST(Table, LeavesCellsEmptyWhereThereIsNoNumber) {
  const std::vector<math::Wrench> none{{Vec3::Zero(), Vec3::Zero()}};
  const std::vector<Row> rows{row("operator", "S1, \"left\"", "simulated", none)};
  EXPECT_THAT(csv(rows), HasSubstr("operator,\"S1, \"\"left\"\"\",simulated,force_xy_N,1,0,,,\n"));
  EXPECT_TRUE(to_json(rows[0])["channels"][0]["mean"].is_null());
}

TEST(Pictures, ShowDepthAndItsMarksWhenTheTractIsKnown) {
  const auto recording = tap();
  const auto answer = replay(runtime(), recording);
  ASSERT_TRUE(answer);
  // The sensor's distance to the entrance along the axis is L where the tip is at the entrance.
  const trial::StatedTract tract{Vec3(6e-3, 6e-3, 15e-3), recording.X_VH[0].q * Vec3::UnitZ(),
                                 0.004};
  const auto figure = trial_figure(recording, *answer, tract, {0.13, Vec3::Zero()});
  ASSERT_EQ(figure.panels.size(), 3u);
  EXPECT_NEAR(figure.panels[0].lines[0].y.front(), 130.0, 1e-9);
  EXPECT_NEAR(figure.panels[2].lines[0].y.front(), 0.0, 1e-5);
  EXPECT_DOUBLE_EQ(figure.panels[0].marks.at(1).at, 126.0);
  EXPECT_EQ(
      trial_figure(recording, *answer, std::nullopt, {0.13, Vec3::Zero()}).panels[0].marks.size(),
      0u);
}

TEST(Pictures, HoldEverySampleInTheDistributions) {
  const std::vector<math::Wrench> measured{{Vec3(0, 0, -2), Vec3::Zero()},
                                           {Vec3(0, 0, 1), Vec3::Zero()}};
  const std::vector<math::Wrench> simulated{{Vec3(0, 0, -4), Vec3::Zero()}};
  const auto figure = distribution_figure(measured, simulated);
  for (const auto& panel : figure.panels)
    for (const auto& steps : panel.steps) {
      double area = 0.0;
      for (std::size_t k = 0; k < steps.y.size(); ++k)
        area += steps.y[k] * (steps.edges[k + 1] - steps.edges[k]);
      EXPECT_NEAR(area, 1.0, 1e-12) << panel.title;
    }
  EXPECT_DOUBLE_EQ(figure.panels[1].steps[0].edges.front(), -4.0);
}

}  // namespace
}  // namespace replay
}  // namespace tractus
