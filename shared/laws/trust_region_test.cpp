#include "laws/trust_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace laws {
namespace {

using math::Mat2;
using math::Vec2;

double model(const Mat2& A, const Vec2& r, const Vec2& s) { return r.dot(s) + 0.5 * s.dot(A * s); }

/// The least of the model over the disc, by trying 2000 directions at the rim and the one place
/// inside where it is level.
double least_by_trying(const Mat2& A, const Vec2& r, double radius) {
  double least = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const double angle = 2 * M_PI * n / 2000;
    least = std::min(least, model(A, r, radius * Vec2(std::cos(angle), std::sin(angle))));
  }
  const Vec2 level = -A.inverse() * r;
  if (level.norm() <= radius) least = std::min(least, model(A, r, level));
  return least;
}

TEST(TrustRegionStep, IsNewtonsWhereTheModelIsABowlAndTheStepFits) {
  const Mat2 A = (Mat2() << 4, 1, 1, 3).finished();
  const Vec2 s = trust_region_step(A, {1, 2}, 10.0);
  EXPECT_NEAR(s.x(), -1.0 / 11, 1e-12);  // A⁻¹ = [3 −1; −1 4]/11; A⁻¹ r = (1, 7)/11
  EXPECT_NEAR(s.y(), -7.0 / 11, 1e-12);
}

TEST(TrustRegionStep, IsAsGoodAsTryingAllDirections) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 2000; ++n) {
    const double a = normal(random), b = normal(random), c = normal(random);
    const double scale = std::exp(3 * normal(random)), radius = std::exp(3 * normal(random));
    const Mat2 A = scale * (Mat2() << a, b, b, c).finished();
    const Vec2 r(normal(random), normal(random));
    const Vec2 s = trust_region_step(A, r, radius);
    ASSERT_LE(s.norm(), radius * (1 + 1e-9));
    const double least = least_by_trying(A, r, radius);
    EXPECT_LE(model(A, r, s), least + 2e-3 * std::abs(least)) << A << "\n" << r << "\n" << radius;
  }
}

TEST(TrustRegionStep, GoesToTheRimWhereItFallsBothWaysAndNothingPushes) {
  const Mat2 A = (Mat2() << -2, 0, 0, 1).finished();
  const Vec2 s = trust_region_step(A, Vec2::Zero(), 0.5);
  EXPECT_NEAR(std::abs(s.x()), 0.5, 1e-12);
  EXPECT_NEAR(s.y(), 0.0, 1e-12);
  EXPECT_EQ(trust_region_step(Mat2::Identity(), Vec2::Zero(), 0.5).norm(), 0.0);
  EXPECT_TRUE(trust_region_step(Mat2::Zero(), Vec2::Zero(), 0.5).allFinite());
  EXPECT_NEAR(trust_region_step(Mat2::Zero(), {0, 3}, 0.5).y(), -0.5, 1e-9);
}

}  // namespace
}  // namespace laws
}  // namespace tractus
