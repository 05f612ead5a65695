/// The palpation effects, each against numbers worked out by hand beside it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "effects/palpation_effect.hpp"
#include "laws/palpation_law.hpp"

namespace tractus {
namespace effects {
namespace {

using laws::ForceSample;

template <class Stage>
std::unique_ptr<Stage> made(const char* id, std::vector<double> values) {
  auto effect = make_palpation_effect({id, std::move(values)});
  EXPECT_TRUE(effect) << effect.error().what;
  return std::move(std::get<std::unique_ptr<Stage>>(*effect));
}

/// CT values rise by 11 a voxel of 0.5 mm along x: opacity is 0.02 i − 150/550, 40 per metre.
volume::ForceField ramp() {
  volume::Volume v;
  v.geometry.dims = {80, 80, 80};
  v.geometry.spacing_m = Vec3::Constant(0.0005);
  for (int k = 0; k < 80; ++k)
    for (int j = 0; j < 80; ++j)
      for (int i = 0; i < 80; ++i) v.counts.push_back(std::uint16_t(11 * i));
  auto field =
      volume::ForceField::make(v, volume::TransferFunction::bone(), volume::FieldKind::paper);
  EXPECT_TRUE(field);
  return std::move(*field);
}

/// A full matrix, so that no product of it hides a transposition.
const Mat3 kSlope = (Mat3() << -900, 40, 10, 55, -300, 70, -20, 35, -120).finished();

/// Is the Jacobian the derivative of the force, as p moves and the elastic force with it?
void expect_own_derivative(const std::function<ForceSample(const ForceSample&)>& law,
                           const Vec3& elastic_N) {
  const ForceSample at = law({elastic_N, kSlope});
  for (int c = 0; c < 3; ++c) {
    const double h = 1e-7;
    const Vec3 dp = h * Vec3::Unit(c);
    const Vec3 after = law({elastic_N + kSlope * dp, kSlope}).force_N;
    const Vec3 before = law({elastic_N - kSlope * dp, kSlope}).force_N;
    EXPECT_LT(((after - before) / (2 * h) - at.jacobian_N_per_m.col(c)).norm(), 1e-2) << c;
  }
}

TEST(ContactFriction, OpposesSlidingByItsShareOfTheNormalForce) {
  // n = −z; of v = (0.03, 0, 0.04) only 0.03 along x slides: −0.2 · 3 N · x̂ = (−0.6, 0, 0).
  const auto friction = made<PointForce>("contact_friction", {0.2, 1.0});
  const PointContact point{Vec3::Zero(), Vec3(0.03, 0, 0.04), nullptr};
  const ForceSample elastic{Vec3(0, 0, -3), Mat3::Zero()};
  ForceSample total = elastic;
  friction->add(point, elastic, total);
  EXPECT_NEAR((total.force_N - Vec3(-0.6, 0, -3)).norm(), 0.0, 1e-5);
}

TEST(ContactFriction, IsNothingWithoutSlidingOrContact) {
  const auto friction = made<PointForce>("contact_friction", {0.2, 1.0});
  for (const ForceSample& elastic :
       {ForceSample{Vec3(0, 0, -3), kSlope}, ForceSample{Vec3::Zero(), kSlope}}) {
    ForceSample total = elastic;
    friction->add({Vec3::Zero(), Vec3(0, 0, 0.04), nullptr}, elastic, total);
    EXPECT_EQ(total.force_N, elastic.force_N);
  }
}

TEST(ContactFriction, KnowsItsDerivative) {
  const auto friction = made<PointForce>("contact_friction", {0.4, 1.0});
  const PointContact point{Vec3::Zero(), Vec3(0.02, -0.01, 0.03), nullptr};
  expect_own_derivative(
      [&](const ForceSample& elastic) {
        ForceSample total = elastic;
        friction->add(point, elastic, total);
        return total;
      },
      Vec3(0.4, -1.1, 2.0));
}

TEST(ContactDamping, IsInProportionToSpeedAndToTheBone) {
  // At x = 20 mm i = 40: opacity 0.8 − 0.2727… = 0.52727…; −10 · 0.52727 · 0.02 = −0.105455 N.
  const auto field = ramp();
  const auto damping = made<PointForce>("contact_damping", {10.0, 1.0});
  ForceSample total{Vec3::Zero(), Mat3::Zero()};
  damping->add({Vec3(0.02, 0.02, 0.02), Vec3(0, 0.02, 0), &field}, total, total);
  EXPECT_NEAR((total.force_N - Vec3(0, -0.10545455, 0)).norm(), 0.0, 1e-6);
  // ∂F_y/∂x = −10 · 0.02 · 40 per metre = −8 N/m.
  EXPECT_NEAR(total.jacobian_N_per_m(1, 0), -8.0, 1e-3);
}

TEST(ContactNonlinearity, RaisesTheFieldToItsPower) {
  // |g| = 40 with g₀ = 20 and p = 2: twice the force.
  const auto law = made<ContactField>("contact_nonlinearity", {2.0, 20.0});
  volume::FieldSample at{Vec3(-40, 0, 0), Mat3::Zero()};
  law->change(at);
  EXPECT_NEAR((at.g_per_m - Vec3(-80, 0, 0)).norm(), 0.0, 1e-12);
}

TEST(ContactNonlinearity, KnowsItsDerivativeAndIsFiniteInFreeSpace) {
  const auto law = made<ContactField>("contact_nonlinearity", {0.6, 3.0});
  const auto changed = [&](const ForceSample& in) {
    volume::FieldSample at{in.force_N, in.jacobian_N_per_m};
    law->change(at);
    return ForceSample{at.g_per_m, at.jacobian_per_m2};
  };
  expect_own_derivative(changed, Vec3(0.4, -1.1, 2.0));
  EXPECT_EQ(changed({Vec3::Zero(), Mat3::Zero()}).force_N, Vec3(Vec3::Zero()));
}

TEST(ContactHysteresis, TakesItsShareOnTheWayOutAlone) {
  const auto law = made<ContactLoss>("contact_hysteresis", {0.3});
  const auto force_N = [&](double v_m_s) {
    ForceSample elastic{Vec3(2, 0, 0), Mat3::Zero()};
    law->change({Vec3::Zero(), Vec3(v_m_s, 0.01, 0), nullptr}, elastic);
    return elastic.force_N.x();
  };
  EXPECT_NEAR(force_N(0.05), 1.4, 1e-5);   // the force pushes along +x: out of the bone
  EXPECT_NEAR(force_N(-0.05), 2.0, 1e-5);  // in
}

TEST(ContactHysteresis, KnowsItsDerivative) {
  const auto law = made<ContactLoss>("contact_hysteresis", {0.5});
  expect_own_derivative(
      [&](ForceSample elastic) {
        law->change({Vec3::Zero(), Vec3(1e-4, 2e-4, 0), nullptr}, elastic);
        return elastic;
      },
      Vec3(0.4, -1.1, 2.0));
}

/// Deflection at z under 1 N across the tip, by stepping v″ = (L − z)/(E I(z)) from the handle on.
double stepped_m_per_N(double z_m, double L, double handle_m, double tip_m, double E) {
  const int n = 39'000;  // 0.13, 0.121 and 0.112 m are whole numbers of steps
  const double h = L / n;
  double slope = 0.0, v = 0.0;
  for (int k = 0; k < int(std::lround(z_m / h)); ++k) {
    const double z = (k + 0.5) * h, r = handle_m + (tip_m - handle_m) * z / L;
    const double curvature = (L - z) / (E * M_PI * std::pow(r, 4) / 4.0);
    v += h * (slope + 0.5 * h * curvature);
    slope += h * curvature;
  }
  return v;
}

TEST(ShankTaper, BendsAsABeamOfThatShape) {
  laws::PalpationParameters p;
  laws::Shank shank = laws::Shank::uniform(p);
  made<ShankForm>("shank_taper", {9e-4, 5e-4})->form(shank);
  const auto v = [&](double z) { return stepped_m_per_N(z, 0.13, 9e-4, 5e-4, 1.95e11); };
  EXPECT_NEAR(shank.stiffness_N_per_m * v(0.13), 1.0, 1e-6);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(shank.shape[i], v(shank.z_m[i]) / v(0.13), 1e-6) << i;
}

TEST(ShankTaper, OfEqualRadiiIsTheUniformShank) {
  laws::PalpationParameters p;
  const laws::Shank uniform = laws::Shank::uniform(p);
  laws::Shank shank = uniform;
  made<ShankForm>("shank_taper", {p.radius_m, p.radius_m})->form(shank);
  EXPECT_NEAR(shank.stiffness_N_per_m / uniform.stiffness_N_per_m, 1.0, 1e-13);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shank.shape[i], uniform.shape[i], 1e-13);
}

TEST(ShankCurvature, LiesOffTheAxisByTheSquareOfItsWay) {
  laws::PalpationParameters p;
  p.points = 2;
  p.point_spacing_m = 0.065;  // the second at half the length
  laws::Shank shank = laws::Shank::uniform(p);
  made<ShankForm>("shank_curvature", {1e-3, M_PI / 2})->form(shank);
  EXPECT_NEAR((shank.rest_m[0] - math::Vec2(0, 1e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((shank.rest_m[1] - math::Vec2(0, 0.25e-3)).norm(), 0.0, 1e-15);
}

TEST(TipBall, IsTheMeanOverABall) {
  // Means of polynomials over a ball of radius R: |x|² → 3R²/5, x⁴ → 3R⁴/35, x²y² → R⁴/35,
  // x¹⁰ → 3R¹⁰/143 (over the sphere xⁿ has the mean 1/(n + 1), rⁿ over the radius 3/(n + 3)).
  const auto ball = made<TipSpread>("tip_ball", {2.0e-3});
  double one = 0, square = 0, fourth = 0, mixed = 0, tenth = 0;
  Vec3 mean = Vec3::Zero();
  for (const auto& [offset, w] : ball->nodes()) {
    const Vec3 x = offset / 2.0e-3;
    one += w, mean += w * x, square += w * x.squaredNorm(), fourth += w * std::pow(x.x(), 4);
    mixed += w * x.x() * x.x() * x.y() * x.y(), tenth += w * std::pow(x.z(), 10);
  }
  EXPECT_NEAR(one, 1.0, 1e-14);
  EXPECT_NEAR(mean.norm(), 0.0, 1e-15);
  EXPECT_NEAR(square, 3.0 / 5.0, 1e-14);
  EXPECT_NEAR(fourth, 3.0 / 35.0, 1e-14);
  EXPECT_NEAR(mixed, 1.0 / 35.0, 1e-14);
  EXPECT_NEAR(tenth, 3.0 / 143.0, 1e-14);
}

TEST(TipBall, IsTheMeanOverASmallBallToTheFifthDegree) {
  for (const double radius_m : {6.9e-4, 9.9e-4}) {
    const auto ball = made<TipSpread>("tip_ball", {radius_m});
    double one = 0, square = 0, fourth = 0, mixed = 0, odd = 0;
    for (const auto& [offset, w] : ball->nodes()) {
      const Vec3 x = offset / radius_m;
      one += w, square += w * x.y() * x.y(), fourth += w * std::pow(x.z(), 4);
      mixed += w * x.x() * x.x() * x.y() * x.y(), odd += w * std::pow(x.x(), 3) * x.y() * x.y();
    }
    EXPECT_NEAR(one, 1.0, 1e-14);
    EXPECT_NEAR(square, 1.0 / 5.0, 1e-14);
    EXPECT_NEAR(fourth, 3.0 / 35.0, 1e-14);
    EXPECT_NEAR(mixed, 1.0 / 35.0, 1e-14);
    EXPECT_NEAR(odd, 0.0, 1e-15);
  }
}

TEST(ProbeWeight, PullsDownInATiltedHandle) {
  // Tilted by 30° about x, down = −z of V is (0, −sin 30°, −cos 30°) in H; 0.1 kg · 9.80665 m/s²;
  // τ = 0.06 ẑ × F = 0.06 (−F_y, F_x, 0).
  const auto weight = made<HandleWrench>("probe_weight", {0.1, 0.06});
  HandleMotion handle;
  handle.X_VH.q = math::Quat(Eigen::AngleAxisd(M_PI / 6, Vec3::UnitX()));
  math::Wrench wrench;
  weight->add(handle, wrench);
  EXPECT_NEAR((wrench.force_N - Vec3(0, -0.4903325, -0.8492808)).norm(), 0.0, 1e-7);
  EXPECT_NEAR((wrench.torque_Nm - Vec3(0.02941995, 0, 0)).norm(), 0.0, 1e-9);
}

TEST(ProbeInertia, ResistsTheAccelerationOfItsOwnPlace) {
  // a = (1, 0, 0) + α × c + ω × (ω × c) with c = 0.05 ẑ, α = 3 ŷ, ω = 2 x̂: + (0.15, 0, 0)
  // + (0, 0, −0.2). F = −0.2 a; τ = 0.05 ẑ × F.
  const auto inertia = made<HandleWrench>("probe_inertia", {0.2, 0.05});
  HandleMotion handle;
  handle.a_m_s2 = Vec3(1, 0, 0);
  handle.alpha_rad_s2 = Vec3(0, 3, 0);
  handle.omega_rad_s = Vec3(2, 0, 0);
  math::Wrench wrench;
  inertia->add(handle, wrench);
  EXPECT_NEAR((wrench.force_N - Vec3(-0.23, 0, 0.04)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((wrench.torque_Nm - Vec3(0, -0.0115, 0)).norm(), 0.0, 1e-15);
}

TEST(PoseOffset, MovesInTheVolumesFrame) {
  math::Pose pose{{1, 2, 3}, math::Quat(Eigen::AngleAxisd(1.0, Vec3::UnitX()))};
  made<PosePlacement>("pose_offset", {1e-3, -2e-3, 0})->place(pose);
  EXPECT_EQ(pose.p, Vec3(1.001, 1.998, 3));
}

TEST(SensorBias, AddsForceAndTorque) {
  math::Wrench wrench{Vec3(1, 0, 0), Vec3::Zero()};
  made<SensorOffset>("sensor_bias", {0.1, 0.2, 0.3, 1e-3, 2e-3, 3e-3})->add(wrench);
  EXPECT_EQ(wrench.force_N, Vec3(1.1, 0.2, 0.3));
  EXPECT_EQ(wrench.torque_Nm, Vec3(1e-3, 2e-3, 3e-3));
}

TEST(PalpationEffects, RefuseWhatLiesOutsideTheirRange) {
  const auto refusal = [](EffectInstance use) {
    const auto effect = make_palpation_effect(use);
    return effect ? "taken" : effect.error().what;
  };
  EXPECT_EQ(
      refusal({"contact_friction", {-0.1, 1.0}}).find("contact_friction/coefficient: -0.1 is"), 0u);
  EXPECT_NE(refusal({"contact_friction", {NAN, 1.0}}), "taken");
  EXPECT_NE(refusal({"contact_friction", {}}), "taken");
  EXPECT_NE(refusal({"coulomb_friction", {1.0}}), "taken");
}

}  // namespace
}  // namespace effects
}  // namespace tractus
