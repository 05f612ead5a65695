#include "models/palpation_runtime.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace tractus {
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

PalpationRuntime with(std::vector<effects::EffectInstance> uses,
                      laws::PalpationParameters base = {}) {
  PalpationModel model;
  model.base = base;
  model.effects = std::move(uses);
  auto runtime = PalpationRuntime::make(model, half_space());
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

/// Down into the surface and along it, 200 samples a second.
PalpationMotion stroke() {
  std::vector<double> t_s;
  std::vector<math::Pose> poses;
  for (int k = 0; k < 400; ++k) {
    const double t = k / 200.0;
    t_s.push_back(t);
    poses.push_back(beside_the_surface(0.002 - 0.004 * std::sin(M_PI * t)));
    poses.back().p.x() = 0.004 * std::sin(3.0 * t);
  }
  auto motion = PalpationMotion::through(t_s, poses);
  EXPECT_TRUE(motion);
  return std::move(*motion);
}

PalpationAnswer answer(const PalpationRuntime& runtime, const PalpationMotion& motion) {
  PalpationAnswer out;
  runtime.predict(motion, out);
  return out;
}

std::vector<std::size_t> every(const PalpationMotion& motion) {
  std::vector<std::size_t> out(motion.t_s.size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

TEST(PalpationRuntime, TakesTheMotionADelayEarlier) {
  const auto motion = stroke();
  const auto now = answer(with({}), motion);
  const auto late = answer(with({{"time_delay", {0.02}}}), motion);  // four samples
  for (std::size_t k = 4; k < motion.t_s.size(); ++k)
    EXPECT_NEAR((late.wrench_H[k].force_N - now.wrench_H[k - 4].force_N).norm(), 0.0, 1e-6) << k;
}

TEST(PalpationRuntime, LeavesMeasurementEffectsOutOfAHand) {
  const auto measured = with({{"pose_offset", {1e-3, -1e-3, 0}},
                              {"sensor_bias", {1, 1, 1, 0.1, 0.1, 0.1}},
                              {"time_delay", {0.05}}});
  const auto plain = with({});
  laws::PalpationState a, b, c;
  const auto pose = beside_the_surface(-0.001);
  EXPECT_EQ(measured.step(pose, a).wrench_H.force_N, plain.step(pose, b).wrench_H.force_N);
  EXPECT_GT(
      (measured.recorded({.X_VH = pose}, c).wrench_H.force_N - plain.step(pose, b).wrench_H.force_N)
          .norm(),
      1.0);
}

TEST(PalpationRuntime, TurnsAboutTheHandleWithTheLeverOfABow) {
  // One point on a shank that hardly bends, bowed by 2 mm along y of H; H is turned by half a turn
  // about x, so y of H is −y of V, and the bone at y < 0 pushes along −y of H where it reaches.
  // A force F ŷ at (0, b, L) has τ = (−L F, 0, 0); the bow adds nothing along y but moves the point
  // deeper: the force is that of a straight shank 2 mm lower.
  laws::PalpationParameters stiff;
  stiff.points = 1;
  stiff.youngs_modulus_Pa = 1e13;
  stiff.radius_m = 0.02;
  const auto bowed = with({{"shank_curvature", {2e-3, M_PI / 2}}}, stiff), plain = with({}, stiff);
  laws::PalpationState a, b;
  const auto one = bowed.step(beside_the_surface(0.0), a);
  const auto other = plain.step(beside_the_surface(-0.002), b);
  EXPECT_NEAR((one.wrench_H.force_N - other.wrench_H.force_N).norm(), 0.0, 1e-5);
  // Across: bowed along x of H by 2 mm at the surface, τ_z = x F_y − y F_x = 0.002 · F_y.
  const auto across = with({{"shank_curvature", {2e-3, 0.0}}}, stiff);
  laws::PalpationState c;
  const auto third = across.step(beside_the_surface(0.0), c);
  EXPECT_GT(std::abs(third.wrench_H.force_N.y()), 0.1);
  EXPECT_NEAR(third.wrench_H.torque_Nm.z(), 0.002 * third.wrench_H.force_N.y(), 1e-9);
}

TEST(PalpationRuntime, LetsFrictionBendTheShank) {
  // Equilibrium with all of F_i: k δ = Σ φ F. With one point at the tip, δ = F_⊥/k.
  laws::PalpationParameters one;
  one.points = 1;
  const auto rough = with({{"contact_friction", {0.3, 1.0}}}, one);
  laws::PalpationState state;
  effects::HandleMotion handle{.X_VH = beside_the_surface(-0.001)};
  handle.v_m_s = Vec3(0.02, 0, 0);
  const auto step = rough.step(handle, state);
  ASSERT_TRUE(step.converged);
  const math::Vec2 across = step.force_H_N[0].head<2>();
  EXPECT_NEAR((step.deflection_m * rough.law().tip_stiffness_N_per_m() - across).norm(), 0.0, 1e-3);
  EXPECT_NEAR(std::abs(across.x()), 0.3 * std::abs(across.y()), 0.02 * std::abs(across.y()));
  EXPECT_LT(across.x() * 0.02, 0.0);  // x of H is x of V: against the motion
}

TEST(PalpationRuntime, FollowsAGivenCourseToTheSameRests) {
  const auto motion = stroke();
  const auto runtime = with({});
  const auto first = answer(runtime, motion);
  PalpationAnswer again;
  runtime.predict_at(motion, every(motion), first.deflection_m, again);
  for (std::size_t k = 0; k < motion.t_s.size(); ++k)
    EXPECT_NEAR((again.wrench_H[k].force_N - first.wrench_H[k].force_N).norm(), 0.0, 1e-5) << k;
}

TEST(PalpationRuntime, RespondsToFirstOrderLikeTheWholeLaw) {
  const auto motion = stroke();
  const auto samples = every(motion);
  laws::PalpationParameters thinner, pressed;
  thinner.radius_m *= 0.999;
  pressed.force_factor_Nm *= 1.001;
  const auto base = with({});
  const auto at = answer(base, motion);
  FieldMemo memo;
  PalpationAnswer same;
  base.respond_at(motion, samples, at.deflection_m, same, memo);
  for (const auto& changed :
       {with({}, thinner), with({}, pressed), with({{"pose_offset", {0, 2e-6, 1e-6}}}),
        with({{"contact_friction", {0.002, 0.5}}})}) {
    PalpationAnswer whole, response;
    changed.predict_at(motion, samples, at.deflection_m, whole);
    changed.respond_at(motion, samples, at.deflection_m, response, memo);
    double missed = 0.0, moved = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      EXPECT_NEAR((same.wrench_H[k].force_N - at.wrench_H[k].force_N).norm(), 0.0, 1e-5);
      missed += (response.wrench_H[k].force_N - whole.wrench_H[k].force_N).squaredNorm();
      moved += (whole.wrench_H[k].force_N - at.wrench_H[k].force_N).squaredNorm();
    }
    EXPECT_LT(missed, 0.05 * 0.05 * moved);
  }
}

/// A ridge of bone 4 mm wide along x and z through the middle of V: a shank cannot be pushed over
/// it, the handle can be moved over it.
volume::Volume ridge() {
  volume::Volume v = half_space();
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i)
        v.counts[v.offset(i, j, k)] = v.count_of(j >= 18 && j < 22 ? 1000 : 0);
  return v;
}
PalpationMotion across_the_ridge() {
  std::vector<double> t_s;
  std::vector<math::Pose> poses;
  for (int k = 0; k < 241; ++k) {
    t_s.push_back(k / 200.0);
    poses.push_back(beside_the_surface(-0.006 + 0.012 * k / 240.0));
  }
  auto motion = PalpationMotion::through(t_s, poses);
  EXPECT_TRUE(motion);
  return std::move(*motion);
}

TEST(PalpationRuntime, ComesFromTheEndToTheOtherSideOfARidge) {
  const auto runtime = PalpationRuntime::make(PalpationModel{}, ridge());
  ASSERT_TRUE(runtime);
  const auto motion = across_the_ridge();
  PalpationAnswer there, back;
  runtime->predict(motion, there);
  runtime->predict(motion, back, true);
  const auto& pose = motion.handle[120].X_VH;
  EXPECT_LT(runtime->tip_m(pose, there.deflection_m[120]).y(), -1e-3);
  EXPECT_GT(runtime->tip_m(pose, back.deflection_m[120]).y(), 1e-3);
}

TEST(PalpationRuntime, DoesNotRespondByGoingElsewhere) {
  PalpationModel moved;
  moved.effects = {{"pose_offset", {0, 4e-3, 0}}};
  const auto base = PalpationRuntime::make(PalpationModel{}, ridge());
  const auto other = PalpationRuntime::make(moved, ridge());
  ASSERT_TRUE(base && other);
  const auto motion = across_the_ridge();
  PalpationAnswer at, response;
  base->predict(motion, at);
  FieldMemo memo;
  other->respond_at(motion, every(motion), at.deflection_m, response, memo);
  for (std::size_t k = 0; k < motion.t_s.size(); ++k)
    EXPECT_LE((response.deflection_m[k] - at.deflection_m[k]).norm(), 0.2001e-3);  // of 1 mm
}

TEST(PalpationRuntime, RefusesWhatTheLawRefuses) {
  PalpationModel model;
  model.base.radius_m = -1;
  EXPECT_FALSE(PalpationRuntime::make(model, half_space()));
}

}  // namespace
}  // namespace models
}  // namespace tractus
