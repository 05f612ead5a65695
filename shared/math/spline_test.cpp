#include "math/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tractus {
namespace math {
namespace {

TEST(CubicSpline, MatchesAHandCalculation) {
  // Natural spline through (0,0) (1,1) (2,0): m1 = 6(−1 −1)/(2·2) = −3; s(½) = ½ + (⅛−½)(−3)/6 =
  // 0.6875.
  const std::vector<double> t{0, 1, 2}, y{0, 1, 0};
  const auto s = CubicSpline::make(t, y);
  ASSERT_TRUE(s);
  EXPECT_DOUBLE_EQ(s->value(0.5), 0.6875);
  EXPECT_DOUBLE_EQ(s->second_derivative(1.0), -3.0);
  EXPECT_DOUBLE_EQ(s->derivative(1.0), 0.0);
}

TEST(CubicSpline, ReproducesAStraightLineAndRefusesTimeRunningBackwards) {
  const std::vector<double> t{0, 0.3, 1, 1.1}, y{1, 1.6, 3, 3.2};
  const auto s = CubicSpline::make(t, y);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->value(0.77), 1 + 2 * 0.77, 1e-14);
  EXPECT_FALSE(CubicSpline::make(std::vector<double>{0, 1, 0.5}, std::vector<double>{0, 1, 2}));
}

TEST(PoseSpline, GivesTheAngularVelocityOfASteadyTurn) {
  // A turn about z at 2 rad/s, one sample with the quaternion's sign flipped.
  std::vector<double> t;
  std::vector<Pose> X;
  for (int k = 0; k <= 100; ++k) {
    t.push_back(k * 0.01);
    Pose pose{{0, 0, 0.1 * t.back()}, Quat(Eigen::AngleAxisd(2.0 * t.back(), Vec3::UnitZ()))};
    if (k == 50) pose.q.coeffs() = -pose.q.coeffs();
    X.push_back(pose);
  }
  const auto s = PoseSpline::make(t, X);
  ASSERT_TRUE(s);
  EXPECT_NEAR((s->angular_velocity_rad_s(0.505) - Vec3(0, 0, 2)).norm(), 0.0, 1e-6);
  EXPECT_NEAR(s->pose(0.505).q.angularDistance(Quat(Eigen::AngleAxisd(1.01, Vec3::UnitZ()))), 0.0,
              1e-8);
  EXPECT_NEAR(s->velocity_m_s(0.3).z(), 0.1, 1e-12);
}

TEST(PoseSpline, KnowsTheAngularAcceleration) {
  // Turning about z by ½ α t² with α = 0.8 rad/s²: ω = α t, its derivative α, along z of V whatever
  // the handle's tilt. Away from the natural ends.
  const Quat tilt(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
  std::vector<double> t;
  std::vector<Pose> X;
  for (int k = 0; k <= 200; ++k) {
    t.push_back(0.01 * k);
    X.push_back(
        {Vec3::Zero(), Quat(Eigen::AngleAxisd(0.4 * t.back() * t.back(), Vec3::UnitZ())) * tilt});
  }
  const auto spline = PoseSpline::make(t, X);
  ASSERT_TRUE(spline);
  EXPECT_NEAR((spline->angular_velocity_rad_s(1.0) - Vec3(0, 0, 0.8)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((spline->angular_acceleration_rad_s2(1.003) - Vec3(0, 0, 0.8)).norm(), 0.0, 1e-3);
}

}  // namespace
}  // namespace math
}  // namespace tractus
