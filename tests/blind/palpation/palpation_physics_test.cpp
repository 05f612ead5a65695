/// The generator's own palpation physics against answers known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palpation/simulate.hpp"

namespace blind {
namespace {

/// A wall across x: CT value rises along x by `slope` per voxel from 0 at voxel 20.
Volume ramp(double slope) {
  Volume v;
  v.size = {48, 24, 24};
  v.spacing_m = Vec3::Constant(5e-4);
  for (int i = 0; i < 24 * 24; ++i)
    for (int x = 0; x < 48; ++x) v.hu.push_back(slope * (x - 20));
  return v;
}

const Transfer kLinear = {{-1000, 0}, {1000, 1}};

/// A probe whose z axis is the volume's z, its tip at `tip`.
Pose upright(const Vec3& tip, const Probe& probe) {
  return {Mat3::Identity(), tip - Vec3(0, 0, probe.length_m)};
}

TEST(BlindPalpation, BeamIsTheTextbookCantilever) {
  // 3 E I / L³ with I = π r⁴ / 4 = 1.8857e-13 m⁴: 50.2 N/m at the published numbers; φ = z² (3L −
  // z) / 2L³.
  const Probe probe;
  const Shank shank = bend(probe, probe.radius_m, probe.radius_m);
  const double inertia = std::numbers::pi * std::pow(0.0007, 4) / 4;
  EXPECT_NEAR(shank.stiffness_N_per_m, 3 * 1.95e11 * inertia / std::pow(0.13, 3), 1e-4);
  for (std::size_t i = 0; i < 3; ++i) {
    const double z = 0.13 - 0.009 * static_cast<double>(i);
    EXPECT_NEAR(shank.shape[i], z * z * (3 * 0.13 - z) / (2 * std::pow(0.13, 3)), 1e-7);
  }
}

TEST(BlindPalpation, TaperedBeamSoftensAsItsEndsSay) {
  const Probe probe;
  const double even = bend(probe, 0.0007, 0.0007).stiffness_N_per_m;
  EXPECT_GT(bend(probe, 0.0008, 0.0007).stiffness_N_per_m, even);
  EXPECT_LT(bend(probe, 0.0007, 0.0005).stiffness_N_per_m, even);
  // Both ends scaled: stiffness as the fourth power.
  EXPECT_NEAR(bend(probe, 0.0014, 0.0014).stiffness_N_per_m / even, 16.0, 1e-9);
}

TEST(BlindPalpation, FieldOfALinearOpacityIsItsSlope) {
  for (const FieldKind kind : {FieldKind::kPaper, FieldKind::kPotential}) {
    const Field field(ramp(20), kLinear, kind);
    const Vec3 g = field.at(Vec3(0.0112, 0.0055, 0.006));
    EXPECT_NEAR(g[0], -20.0 / 2000.0 / 5e-4, 1e-9);
    EXPECT_NEAR(g[1], 0.0, 1e-9);
    EXPECT_NEAR(field.opacity(Vec3(0.0112, 0.0055, 0.006)),
                0.5 + 20.0 / 2000.0 * (0.0112 / 5e-4 - 20), 1e-12);
  }
}

TEST(BlindPalpation, ShankBendsUntilItsStiffnessCarriesTheField) {
  // Uniform field gx: every point sees c g, δ = Σ φ_i c g / k; wrench sums them.
  const Field field(ramp(20), kLinear, FieldKind::kPaper);
  const Probe probe;
  PalpationPhysics physics(field, probe, {});
  const Pose pose = upright(Vec3(0.0115, 0.006, 0.026), probe);
  const Wrench w = physics.step(pose, pose, pose, 1e-3);
  const double one = 0.005 * -20.0 / 2000.0 / 5e-4;
  const Shank shank = bend(probe, 0.0007, 0.0007);
  const double sum = shank.shape[0] + shank.shape[1] + shank.shape[2];
  EXPECT_NEAR(physics.deflection()[0], one * sum / shank.stiffness_N_per_m, 1e-7);
  EXPECT_NEAR(w.force_N[0], 0.3 * 3 * one, 1e-9);
  EXPECT_NEAR(w.torque_Nm[1], 0.3 * (0.13 + 0.121 + 0.112) * one, 1e-9);
}

TEST(BlindPalpation, DampingAndFrictionOpposeTheSlide) {
  const Field field(ramp(20), kLinear, FieldKind::kPaper);
  const Probe probe;
  const double v = 0.004, dt = 1e-3;
  const auto pose = [&](double t) { return upright(Vec3(0.0115, 0.006, 0.006 + v * t), probe); };
  const auto extra = [&](const Hidden& effect) {
    PalpationPhysics with(field, probe, {effect}), bare(field, probe, {});
    const Wrench a = with.step(pose(-dt), pose(0), pose(dt), dt);
    return Vec3(a.force_N - bare.step(pose(-dt), pose(0), pose(dt), dt).force_N);
  };
  const double one = 0.005 * 20.0 / 2000.0 / 5e-4;
  const Vec3 rub = extra({"contact_friction", {{"coefficient", {0.2}}, {"bends_shank", {1}}}});
  EXPECT_NEAR(rub[2], -0.3 * 3 * 0.2 * one, 1e-9);
  const Vec3 drag = extra({"contact_damping", {{"damping_Ns_per_m", {5}}, {"bends_shank", {1}}}});
  EXPECT_LT(drag[2], 0.0);
  EXPECT_NEAR(drag[2], -0.3 * 3 * 5 * v * 0.53,
              0.3 * 3 * 5 * v * 0.1);  // opacity about 0.53 where it rests
}

TEST(BlindPalpation, WeightHangsDownWhateverTheHandle) {
  const Field field(ramp(0), kLinear, FieldKind::kPaper);
  const Probe probe;
  PalpationPhysics physics(field, probe,
                           {{"probe_weight", {{"mass_kg", {0.05}}, {"centre_m", {0.04}}}}});
  Pose lying{Mat3(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix()),
             Vec3(0.011, 0.006, 0.006)};
  const Wrench w = physics.step(lying, lying, lying, 1e-3);
  EXPECT_NEAR((lying.R * w.force_N)[2], -0.05 * 9.80665, 1e-12);
  EXPECT_NEAR(w.torque_Nm.norm(), 0.04 * 0.05 * 9.80665, 1e-12);
}

TEST(BlindPalpation, ConservativeFieldDoesNoWorkRoundALoop) {
  Random random(4);
  Volume volume = bone_block(random);
  const Tract tract = draw_tract(random, volume);
  carve(volume, tract, 0, 100);
  const Field field(volume, {{100, 0}, {600, 1}}, FieldKind::kPotential);
  const Vec3 centre = tract.entry_m + 0.015 * tract.along + tract.radius_m * tract.across;
  double work = 0, moved = 0;
  constexpr int kSteps = 4000;
  const auto at = [&](double i) {
    const double a = 2 * std::numbers::pi * i / kSteps;
    return Vec3(centre + 6e-4 * (std::cos(a) * tract.across + std::sin(a) * tract.along));
  };
  for (int i = 0; i < kSteps; ++i) {
    const double piece = field.at(at(i + 0.5)).dot(at(i + 1) - at(i));
    work += piece;
    moved += std::abs(piece);
  }
  EXPECT_GT(moved, 0.1);
  EXPECT_LT(std::abs(work), 1e-4 * moved);
}

}  // namespace
}  // namespace blind
