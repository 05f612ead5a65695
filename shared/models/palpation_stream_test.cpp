/// Moment by moment as over the whole motion.
#include "models/palpation_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/spline.hpp"

namespace tractus {
namespace models {
namespace {

using math::Vec3;

/// Bone of 1000 HU where y < 0 with a groove along z, soft tissue elsewhere; 1 mm voxels, V centred.
const volume::Volume& grooved_bone() {
  static const volume::Volume kBone = [] {
    volume::Volume v{.geometry = {{40, 40, 40},
                                  Vec3::Constant(1e-3),
                                  Vec3::Constant(-0.0195),
                                  volume::Mat3::Identity()},
                     .slope = 1,
                     .intercept = -1024,
                     .counts = {}};
    for (int k = 0; k < 40; ++k)
      for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) v.counts.push_back(v.count_of(j < 20 - (i == 19) ? 1000 : 0));
    return v;
  }();
  return kBone;
}

PalpationRuntime stream_runtime(std::vector<effects::EffectInstance> uses) {
  PalpationModel model;
  model.effects = std::move(uses);
  auto runtime = PalpationRuntime::make(model, grooved_bone());
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

struct TurningPoses {
  std::vector<double> t_s;
  std::vector<math::Pose> X_VH;
};

/// Into the surface, along it and out of it, turning about all axes: 1.5 s.
TurningPoses poses(double rate_Hz) {
  TurningPoses out;
  for (int k = 0; k <= int(std::lround(1.5 * rate_Hz)); ++k) {
    const double t = k / rate_Hz;
    const math::Quat q =
        math::Quat(Eigen::AngleAxisd(0.05 * std::sin(3.0 * t), Vec3::UnitX())) *
        math::Quat(0, 1, 0, 0) *
        math::Quat(Eigen::AngleAxisd(0.8 * t + 0.2 * std::cos(5.0 * t), Vec3::UnitZ()));
    const Vec3 tip(0.004 * std::sin(4.0 * t), 0.0015 - 0.0045 * std::sin(M_PI * t / 1.5),
                   0.001 * t);
    out.t_s.push_back(2.0 + t);
    out.X_VH.push_back({tip - 0.13 * (q * Vec3::UnitZ()), q});
  }
  return out;
}

PalpationMotion turning_stroke(double rate_Hz) {
  const auto recorded = poses(rate_Hz);
  auto motion = PalpationMotion::through(recorded.t_s, recorded.X_VH);
  EXPECT_TRUE(motion);
  return std::move(*motion);
}

/// Largest difference of force (N) and torque (N·m) from the prediction, and the largest force.
struct Compared {
  double difference = 0.0, force_N = 0.0;
};
Compared compared(const PalpationRuntime& runtime, const PalpationMotion& motion) {
  PalpationAnswer whole;
  runtime.predict(motion, whole);
  PalpationStream stream(runtime);
  Compared out;
  for (std::size_t k = 0; k < motion.t_s.size(); ++k) {
    const auto step = stream.keep(motion.t_s[k], motion.handle[k]);
    out.difference =
        std::max({out.difference, (step.wrench_H.force_N - whole.wrench_H[k].force_N).norm(),
                  (step.wrench_H.torque_Nm - whole.wrench_H[k].torque_Nm).norm()});
    out.force_N = std::max(out.force_N, step.wrench_H.force_N.norm());
    EXPECT_EQ(step.converged, bool(whole.converged[k]));
  }
  return out;
}

/// The catalogue's effects at their initial values, or a little off those that change nothing.
std::vector<effects::EffectInstance> every_effect() {
  std::vector<effects::EffectInstance> out;
  for (const auto& info : effects::palpation_effects()) {
    effects::EffectInstance use{info.facts.id, {}};
    for (const auto& p : info.facts.params)
      use.values.insert(use.values.end(), std::size_t(p.components),
                        p.initial == p.off ? p.initial + 0.02 * (p.high - p.low) : p.initial);
    out.push_back(use);
  }
  return out;
}

TEST(PalpationStream, AnswersAsThePredictionOverTheWholeMotionWithEachEffect) {
  // At the rate of its steps both take one step from sample to sample: the same numbers, to the last bit
  // but for a delay, which the prediction takes from the nearest sample on.
  const PalpationMotion motion = turning_stroke(kPalpationRate_Hz);
  for (const auto& use : every_effect()) {
    const auto [difference, force_N] = compared(stream_runtime({use}), motion);
    EXPECT_GT(force_N, 0.1) << use.id;
    EXPECT_LE(difference, use.id == "time_delay" ? 1e-6 : 0.0) << use.id;
  }
}

TEST(PalpationStream, AnswersSoWithEveryEffectAtOnceAtTheRateOfARecording) {
  // 200 samples a second: the ways between the samples differ, the rests that they come to do not.
  auto all = every_effect();
  const auto [difference, force_N] = compared(stream_runtime(all), turning_stroke(200.0));
  EXPECT_GT(force_N, 0.1);
  EXPECT_LT(difference, 1e-4 * force_N);
}

TEST(PalpationStream, ForgetsNothingThatALongDelayReaches) {
  // A copy of the motion that starts 0.15 s later gives the forces of then: 600 samples.
  const PalpationMotion motion = turning_stroke(kPalpationRate_Hz);
  const auto now = stream_runtime({}), late = stream_runtime({{"time_delay", {0.15}}});
  PalpationStream a(now), b(late);
  std::vector<Vec3> force_N;
  for (std::size_t k = 0; k < motion.t_s.size(); ++k) {
    force_N.push_back(a.keep(motion.t_s[k], motion.handle[k]).wrench_H.force_N);
    const Vec3 then_N = b.keep(motion.t_s[k], motion.handle[k]).wrench_H.force_N;
    ASSERT_LT((then_N - force_N[k < 600 ? 0 : k - 600]).norm(), 1e-5) << k;
  }
}

TEST(PalpationStream, ADelayShorterThanAStepIsOnTheCubicBetweenTwoMoments) {
  // 2 kg at the handle's origin, no bone near: F = −m (a − g). x = t³ has a = 6t; at 1.5 s, 0.125 s late
  // between moments 0.5 s apart, a = 8.25.
  const auto runtime = stream_runtime({{"probe_inertia", {2.0, 0.0}}, {"time_delay", {0.125}}});
  PalpationStream stream(runtime);
  laws::PalpationStep last;
  for (const double t : {0.0, 0.5, 1.0, 1.5})
    last = stream.keep(t, {.X_VH = {Vec3(t * t * t, 5.0, 5.0), math::Quat::Identity()},
                           .v_m_s = Vec3(3.0 * t * t, 0, 0),
                           .a_m_s2 = Vec3(6.0 * t, 0, 0)});
  EXPECT_NEAR(last.wrench_H.force_N.x(), -2.0 * 8.25, 1e-12);
}

TEST(PalpationStream, ACopyGoesOnFromWhereTheOriginalStands) {
  const auto runtime = stream_runtime({{"contact_friction", {0.3, 1.0}}, {"time_delay", {0.01}}});
  const PalpationMotion motion = turning_stroke(1000.0);
  PalpationStream one(runtime);
  for (std::size_t k = 0; k < 700; ++k) one.keep(motion.t_s[k], motion.handle[k]);
  PalpationStream two = one;
  std::vector<Vec3> first_N;
  for (std::size_t k = 700; k < 1200; ++k)
    first_N.push_back(one.keep(motion.t_s[k], motion.handle[k]).wrench_H.force_N);
  for (std::size_t k = 700; k < 1200; ++k)
    ASSERT_EQ(two.keep(motion.t_s[k], motion.handle[k]).wrench_H.force_N, first_N[k - 700]) << k;
}

TEST(PalpationWalk, KnowingAllOfTheMotionIsAsKnowingItUpToNow) {
  const auto runtime = stream_runtime(every_effect());
  const PalpationMotion motion = turning_stroke(130.0);
  PalpationWalk walk(runtime);
  PalpationStream stream(runtime);
  for (std::size_t k = 0; k < motion.t_s.size(); ++k)
    ASSERT_EQ(walk.to(motion.t_s[k], motion).wrench_H.force_N,
              stream.keep(motion.t_s[k], motion.handle[k]).wrench_H.force_N)
        << k;
}

TEST(BetweenSamples, IsTheSplineThatTheDerivativesCameFrom) {
  const auto recorded = poses(100.0);
  const auto spline = math::PoseSpline::make(recorded.t_s, recorded.X_VH);
  ASSERT_TRUE(spline);
  const PalpationMotion motion = turning_stroke(100.0);
  for (double t = 2.0; t < 3.5; t += 1.7e-3) {
    const auto at = between_samples(motion, t);
    EXPECT_LT((at.X_VH.p - spline->pose(t).p).norm(), 1e-15);
    EXPECT_LT(at.X_VH.q.angularDistance(spline->pose(t).q), 1e-8);
    EXPECT_LT((at.v_m_s - spline->velocity_m_s(t)).norm(), 1e-12);
    EXPECT_LT((at.a_m_s2 - spline->acceleration_m_s2(t)).norm(), 1e-10);
    EXPECT_LT((at.omega_rad_s - spline->angular_velocity_rad_s(t)).norm(), 1e-5);
    EXPECT_LT((at.alpha_rad_s2 - spline->angular_acceleration_rad_s2(t)).norm(), 2e-3);
  }
}

TEST(BetweenSamples, GoesStraightWithoutAccelerationsAndRestsBeforeAndAfter) {
  PalpationMotion motion;
  motion.t_s = {1.0, 3.0};
  const math::Quat quarter(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  math::Quat other = quarter;
  other.coeffs() = -other.coeffs();  // the same turn
  motion.handle = {{.X_VH = {Vec3(1, 0, 0), math::Quat::Identity()}},
                   {.X_VH = {Vec3(5, 2, 0), other}}};
  const auto middle = between_samples(motion, 2.0);
  EXPECT_LT((middle.X_VH.p - Vec3(3, 1, 0)).norm(), 1e-15);
  EXPECT_LT((middle.v_m_s - Vec3(2, 1, 0)).norm(), 1e-15);
  EXPECT_NEAR(middle.X_VH.q.angularDistance(math::Quat::Identity()), M_PI / 4, 1e-12);
  EXPECT_EQ(between_samples(motion, 0.5).X_VH.p, Vec3(1, 0, 0));
  EXPECT_EQ(between_samples(motion, 9.0).X_VH.p, Vec3(5, 2, 0));
}

}  // namespace
}  // namespace models
}  // namespace tractus
