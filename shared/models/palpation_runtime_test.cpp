#include "models/palpation_runtime.hpp"

#include <gtest/gtest.h>

namespace models {
namespace {

using math::Vec3;

/// Bone of 1000 HU where y < 0, soft tissue elsewhere; 1 mm voxels, V centred.
volume::Volume half_space() {
  volume::Volume v{.geometry = {{40, 40, 40},
                                Vec3::Constant(1e-3),
                                Vec3::Constant(-0.0195),
                                volume::Mat3::Identity()},
                   .slope = 1,
                   .intercept = -1024,
                   .counts = {}};
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) v.counts.push_back(v.count_of(j < 20 ? 1000 : 0));
  return v;
}

/// The handle above the surface, the shank along −z: the tip at z = 0, the points at `y`.
math::Pose beside_the_surface(double y_m) { return {{0, y_m, 0.13}, math::Quat(0, 1, 0, 0)}; }

TEST(PalpationRuntime, PushesTheProbeOutOfTheBone) {
  const auto runtime = PalpationRuntime::make(PalpationModel{}, half_space());
  ASSERT_TRUE(runtime) << runtime.error().what;
  laws::PalpationState state;
  const auto pose = beside_the_surface(0.0005);
  const auto step = runtime->step(pose, state);
  EXPECT_GT((pose.q * step.wrench_H.force_N).y(), 0.01);  // bone lies at y < 0: −∇α points to +y
  state = {};
  EXPECT_LT(runtime->step(beside_the_surface(0.015), state).wrench_H.force_N.norm(),
            1e-9);  // 15 mm off
}

TEST(PalpationRuntime, AddsThePoseOffsetToThePositionInV) {
  PalpationModel model;
  const auto plain = PalpationRuntime::make(model, half_space());
  model.base.pose_offset_m = {0, 0.0045, 0.0005};
  const auto moved = PalpationRuntime::make(model, half_space());
  ASSERT_TRUE(plain && moved);
  math::Pose pose = beside_the_surface(-0.004);
  laws::PalpationState a, b;
  const auto by_model = moved->step(pose, a);
  const Vec3 tip = moved->tip_m(pose, by_model.deflection_m);
  pose.p += Vec3(0, 0.0045, 0.0005);
  const auto by_hand = plain->step(pose, b);
  EXPECT_GT(by_hand.wrench_H.force_N.norm(), 0.01);
  EXPECT_EQ(by_model.wrench_H.force_N, by_hand.wrench_H.force_N);
  EXPECT_EQ(by_model.wrench_H.torque_Nm, by_hand.wrench_H.torque_Nm);
  EXPECT_EQ(tip, plain->tip_m(pose, by_hand.deflection_m));
}

TEST(PalpationRuntime, RefusesWhatTheLawRefuses) {
  PalpationModel model;
  model.base.radius_m = -1;
  EXPECT_FALSE(PalpationRuntime::make(model, half_space()));
}

}  // namespace
}  // namespace models
