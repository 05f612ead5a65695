#include "laws/palpation_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace tractus {
namespace laws {

long allocations() noexcept;  // of this program so far: allocations_test.cpp

namespace {

using math::Pose;
using math::Quat;
using volume::FieldKind;
using volume::ForceField;
using volume::Volume;

ForceField field_of(const Volume& volume, FieldKind kind = FieldKind::paper) {
  auto field = ForceField::make(volume, volume::TransferFunction::bone(), kind);
  EXPECT_TRUE(field);
  return std::move(field).value();
}

/// CT values rise by 11 a voxel of 0.5 mm along x: opacity by 11/550 = 0.02 a voxel, 40 per metre,
/// from voxel 15 to 65.
Volume ramp() {
  Volume v;
  v.geometry.dims = {80, 80, 80};
  v.geometry.spacing_m = Vec3::Constant(0.0005);
  for (int k = 0; k < 80; ++k)
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 80; ++i) v.counts.push_back(std::uint16_t(11 * i));
  return v;
}

/// The unbent tip in the middle of the ramp, the axes those of the volume.
Pose in_the_ramp() { return {Vec3(0.025, 0.02, 0.02 - 0.13), Quat::Identity()}; }

/// A tract of 3 mm diameter along z, from the surface at 8 mm to its end at 30 mm, in bone of
/// uneven values.
Volume tract() {
  Volume v;
  v.geometry.dims = {56, 56, 110};
  v.geometry.spacing_m = Vec3::Constant(0.00035);
  std::mt19937 random(1);
  for (int k = 0; k < 110; ++k)
    for (int j = 0; j < 56; ++j)
      for (int i = 0; i < 56; ++i) {
        const double off = std::hypot(i - 27.5, j - 27.5) * 0.00035, z = k * 0.00035;
        const bool air = z < 0.008 || (z < 0.030 && off < 0.0015);
        v.counts.push_back(air ? std::uint16_t(0) : std::uint16_t(450 + random() % 250));
      }
  return v;
}

/// A hand at time t, s: strokes along the walls all round, pressing up to 6 mm, and taps on the
/// end.
Pose hand(double t) {
  const double depth_m = 0.020 + 0.0102 * std::sin(2 * M_PI * 0.9 * t);
  const double press_m = 0.003 * (1 - std::cos(2 * M_PI * 1.3 * t)), around = 2 * M_PI * 0.21 * t;
  const Quat q(Eigen::AngleAxisd(0.03 * std::sin(2.1 * t), Vec3::UnitX()));
  const Vec3 tip(0.009625 + press_m * std::cos(around), 0.009625 + press_m * std::sin(around),
                 depth_m);
  return {tip - q * Vec3(0, 0, 0.13), q};
}

PalpationLaw law_of(const PalpationParameters& parameters, const ForceField& field) {
  auto law = PalpationLaw::make(parameters, field);
  EXPECT_TRUE(law);
  return std::move(law).value();
}

/// Σ φ F_⊥ − k δ at the answer, from the equations as the design states them.
double miss_N(const PalpationParameters& p, const ForceField& field, const Pose& X_VH,
              const Vec2& deflection_m) {
  const double L = p.length_m,
               k = 3 * p.youngs_modulus_Pa * M_PI * std::pow(p.radius_m, 4) / 4 / std::pow(L, 3);
  Vec2 sum = -k * deflection_m;
  for (int i = 0; i < p.points; ++i) {
    const double z = L - i * p.point_spacing_m, shape = z * z * (3 * L - z) / (2 * L * L * L);
    const Vec3 p_H(shape * deflection_m.x(), shape * deflection_m.y(), z);
    const Vec3 F = p.force_factor_Nm * (X_VH.q.conjugate() * field.gradient_per_m(X_VH * p_H));
    sum += shape * F.head<2>();
  }
  return sum.norm();
}

TEST(AddToWrench, AddsTheScaledForceAndItsMomentAboutTheOrigin) {
  math::Wrench wrench{Vec3(1, 0, 0), Vec3(0, 0, 1)};
  // By hand: (0.01, −0.02, 0.13) × (2, 3, −1) = (0.02 − 0.39, 0.26 + 0.01, 0.03 + 0.04).
  add_to_wrench(Vec3(0.01, -0.02, 0.13), Vec3(2, 3, -1), 0.5, 0.25, wrench);
  EXPECT_LT((wrench.force_N - Vec3(2.0, 1.5, -0.5)).norm(), 1e-15);
  EXPECT_LT((wrench.torque_Nm - Vec3(-0.0925, 0.0675, 1.0175)).norm(), 1e-15);
}

TEST(PalpationLaw, BendsATipInAUniformFieldByForceOverStiffness) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  PalpationParameters p;
  p.points = 1;
  const PalpationLaw law = law_of(p, field);
  // I = π 0.7⁴/4 mm⁴ = 1.885741e-13 m⁴; k = 3 · 1.95e11 · I / 0.13³ = 50.2120 N/m.
  EXPECT_NEAR(law.tip_stiffness_N_per_m(), 50.2120, 1e-3);
  PalpationState state;
  const PalpationStep step = law.step(in_the_ramp(), state);
  EXPECT_TRUE(step.converged);
  EXPECT_NEAR(step.force_H_N[0].x(), 0.005 * -40, 1e-5);     // c_f g = −0.2 N
  EXPECT_NEAR(step.deflection_m.x(), -0.2 / 50.2120, 1e-7);  // −3.9831 mm
  EXPECT_NEAR(step.deflection_m.y(), 0.0, 1e-7);
  EXPECT_NEAR(step.wrench_H.force_N.x(), 0.3 * -0.2, 1e-5);
  EXPECT_NEAR(step.wrench_H.torque_Nm.y(), 0.3 * 0.13 * -0.2, 1e-6);  // z × F: about −y
  EXPECT_EQ(state.deflection_m, step.deflection_m);
  EXPECT_NEAR(
      (law.tip_m(in_the_ramp(), step.deflection_m) - Vec3(0.025 - 0.2 / 50.2120, 0.02, 0.02))
          .norm(),
      0.0, 1e-7);
}

TEST(PalpationLaw, SumsThreePointsByTheirShapes) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  const PalpationLaw law = law_of({.point_spacing_m = 0.003}, field);
  PalpationState state;
  const PalpationStep step = law.step(in_the_ramp(), state);
  // φ(0.127) = 0.127² (0.39 − 0.127)/(2 · 0.13³) = 0.965391; φ(0.124) = 0.124² · 0.266/0.004394 =
  // 0.930818.
  const double shapes = 1.0 + 0.965391 + 0.930818;
  EXPECT_NEAR(step.deflection_m.x(), -0.2 * shapes / 50.2120, 2e-7);
  EXPECT_NEAR(step.wrench_H.force_N.x(), 0.3 * 3 * -0.2, 2e-5);
  EXPECT_NEAR(step.wrench_H.torque_Nm.y(), 0.3 * -0.2 * (0.13 + 0.127 + 0.124), 2e-6);
  EXPECT_NEAR(law.point_H_m(2, step.deflection_m).x(), 0.930818 * step.deflection_m.x(), 1e-8);
}

TEST(PalpationLaw, LetsABentProbeGoStraightInFreeSpace) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  const PalpationLaw law = law_of({}, field);
  PalpationState state{Vec2(0.01, -0.02)};
  const PalpationStep step = law.step({Vec3(-0.5, 0.02, 0.02), Quat::Identity()}, state);
  EXPECT_TRUE(step.converged);
  EXPECT_LT(step.deflection_m.norm(), 1e-7);
  EXPECT_LT(step.wrench_H.force_N.norm(), 1e-5);
  EXPECT_LT(step.wrench_H.torque_Nm.norm(), 1e-6);
}

TEST(PalpationLaw, ScalesForceAndTorqueEachByItsOwnFactor) {
  const Volume v = tract();
  const ForceField field = field_of(v);
  PalpationState a, b;
  const PalpationStep one = law_of({}, field).step(hand(0.35), a);
  const PalpationStep other =
      law_of({.force_scale = 0.6, .torque_scale = 0.9}, field).step(hand(0.35), b);
  ASSERT_GT(one.wrench_H.force_N.norm(), 0.01);
  EXPECT_NEAR((other.wrench_H.force_N - 2 * one.wrench_H.force_N).norm(), 0.0, 1e-12);
  EXPECT_NEAR((other.wrench_H.torque_Nm - 3 * one.wrench_H.torque_Nm).norm(), 0.0, 1e-12);
}

TEST(PalpationLaw, BendsASixteenthAsFarAtTwiceTheRadius) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  PalpationState thin, thick;
  const double bent_m = law_of({.points = 1}, field).step(in_the_ramp(), thin).deflection_m.x();
  const double stiff_m =
      law_of({.points = 1, .radius_m = 0.0014}, field).step(in_the_ramp(), thick).deflection_m.x();
  EXPECT_NEAR(bent_m / stiff_m, 16.0, 1e-3);
}

TEST(PalpationLaw, GivesTheSameWrenchInTheHandleWhereverThePatientLies) {
  Volume v = tract();
  const ForceField field = field_of(v);
  const Pose X{Vec3(0.3, -0.2, 0.1), Quat(Eigen::AngleAxisd(1.1, Vec3(3, -1, 2).normalized()))};
  v.geometry.origin_m = X.p;
  v.geometry.directions = X.q.toRotationMatrix();
  const ForceField moved_field = field_of(v);
  const PalpationLaw law = law_of({}, field), moved_law = law_of({}, moved_field);
  PalpationState state, moved_state;
  double largest_N = 0.0;
  for (int n = 0; n < 400; ++n) {
    const PalpationStep step = law.step(hand(n / 400.0), state);
    const PalpationStep moved = moved_law.step(X * hand(n / 400.0), moved_state);
    EXPECT_LE((step.wrench_H.force_N - moved.wrench_H.force_N).norm(), 1e-4);
    EXPECT_LE((step.wrench_H.torque_Nm - moved.wrench_H.torque_Nm).norm(), 1e-5);
    largest_N = std::max(largest_N, step.wrench_H.force_N.norm());
  }
  EXPECT_GT(largest_N, 0.3);
}

class LawInATract : public testing::TestWithParam<FieldKind> {};

TEST_P(LawInATract, IsAtRestByTheEquationsWrittenStraight) {
  const Volume v = tract();
  const ForceField field = field_of(v, GetParam());
  const PalpationParameters p;
  const PalpationLaw law = law_of(p, field);
  PalpationState state;
  int failed = 0, touched = 0;
  constexpr int kSteps = 20000;
  for (int n = 0; n < kSteps; ++n) {
    const Pose X_VH = hand(n / 4000.0);
    const PalpationStep step = law.step(X_VH, state);
    EXPECT_EQ(step.converged, miss_N(p, field, X_VH, step.deflection_m) < 0.001) << "at step " << n;
    failed += !step.converged;
    touched += step.wrench_H.force_N.norm() > 0.01;
    ASSERT_LE(step.iterations, 60);
  }
  EXPECT_GT(touched, kSteps / 2);
  EXPECT_LE(failed, GetParam() == FieldKind::paper ? kSteps / 100 : kSteps / 10000);
}

TEST_P(LawInATract, AnswersTheSameFromTheLastBendingOrNearIt) {
  const Volume v = tract();
  const ForceField field = field_of(v, GetParam());
  const PalpationLaw law = law_of({}, field);
  PalpationState state;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> near_m(-20e-6, 20e-6);
  int differ = 0;
  for (int n = 0; n < 4000; ++n) {
    PalpationState near{state.deflection_m + Vec2(near_m(random), near_m(random))};
    const Pose X_VH = hand(n / 4000.0);
    const PalpationStep a = law.step(X_VH, state), b = law.step(X_VH, near);
    differ += (a.wrench_H.force_N - b.wrench_H.force_N).norm() > 1e-3;
  }
  EXPECT_LE(differ, 40) << "a bistable place may tip either way, but it is rare";
}

TEST_P(LawInATract, AllocatesNothingInAStep) {
  const Volume v = tract();
  const ForceField field = field_of(v, GetParam());
  const PalpationLaw law = law_of({.points = 64, .point_spacing_m = 0.0005}, field);
  PalpationState state;
  const long before = allocations();
  for (int n = 0; n < 500; ++n) (void)law.step(hand(n / 500.0), state);
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(before, 0) << "the counter must count";
}

INSTANTIATE_TEST_SUITE_P(Fields, LawInATract,
                         testing::Values(FieldKind::paper, FieldKind::potential),
                         [](const auto& test) {
                           return test.param == FieldKind::paper ? "Paper" : "Potential";
                         });

TEST(PalpationLaw, AgreesWithPatientRelaxation) {
  // The published way, with a gain small enough never to overshoot and 20 times the published
  // iterations.
  const Volume v = tract();
  const ForceField field = field_of(v);
  const PalpationParameters p;
  const PalpationLaw law = law_of(p, field);
  PalpationState state;
  Vec2 relaxed = Vec2::Zero();
  std::vector<double> differences_N;
  for (int n = 0; n < 400; ++n) {
    const Pose X_VH = hand(n / 2000.0);
    const PalpationStep step = law.step(X_VH, state);
    Vec3 force_N = Vec3::Zero();
    for (int iteration = 0; iteration < 20000; ++iteration) {
      Vec2 at_tip = -law.tip_stiffness_N_per_m() * relaxed;
      force_N.setZero();
      for (int i = 0; i < p.points; ++i) {
        const Vec3 p_H = law.point_H_m(i, relaxed);
        const Vec3 F = p.force_factor_Nm * (X_VH.q.conjugate() * field.gradient_per_m(X_VH * p_H));
        at_tip += law.point_H_m(i, Vec2(1, 0)).x() * F.head<2>();
        force_N += p.force_scale * F;
      }
      if (at_tip.norm() < 1e-4) break;
      relaxed += 2e-6 * at_tip;
    }
    differences_N.push_back((force_N - step.wrench_H.force_N).norm());
  }
  std::ranges::sort(differences_N);
  EXPECT_LE(differences_N[360], 0.001) << "nine steps of ten, within the tolerance of rest";
}

TEST(PalpationLaw, AnswersAPoseThatIsNoNumberWithNoForceAndSaysSo) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  const PalpationLaw law = law_of({}, field);
  PalpationState state{Vec2(0.001, 0)};
  const PalpationStep step = law.step({Vec3(std::nan(""), 0, 0), Quat::Identity()}, state);
  EXPECT_FALSE(step.converged);
  EXPECT_EQ(step.wrench_H.force_N.norm(), 0.0);
  EXPECT_TRUE(state.deflection_m.allFinite());
  state.deflection_m.x() = std::nan("");
  EXPECT_TRUE(law.step(in_the_ramp(), state).converged) << "a spoilt state is not kept";
}

TEST(PalpationLaw, NamesTheFirstParameterOutsideItsRange) {
  const Volume v = ramp();
  const ForceField field = field_of(v);
  const auto refused = [&](const PalpationParameters& p) {
    const auto law = PalpationLaw::make(p, field);
    EXPECT_FALSE(law);
    if (law) return std::string();
    EXPECT_EQ(law.error().code, core::Errc::out_of_range);
    return law.error().what.substr(0, law.error().what.find(':'));
  };
  EXPECT_EQ(refused({.points = 0}), "points");
  EXPECT_EQ(refused({.points = 65}), "points");
  EXPECT_EQ(refused({.length_m = -0.1}), "length_m");
  EXPECT_EQ(refused({.radius_m = std::nan("")}), "radius_m");
  EXPECT_EQ(refused({.points = 16}), "point_spacing_m")
      << "15 gaps of 9 mm are longer than the shank";
  EXPECT_EQ(refused({.force_factor_Nm = INFINITY}), "force_factor_Nm");
}

}  // namespace
}  // namespace laws
}  // namespace tractus
