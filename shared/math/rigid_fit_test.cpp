#include "math/rigid_fit.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace tractus::math {
namespace {

// By hand: a quarter turn about z carries (x, y, z) to (−y, x, z).
TEST(RigidFit, FindsAQuarterTurnAndAShift) {
  const std::vector<Vec3> b{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  const std::vector<Vec3> a{{5, 6, 7}, {5, 7, 7}, {3, 6, 7}, {5, 6, 10}};
  const Pose X_AB = rigid_fit(a, b);
  EXPECT_LT((X_AB.p - Vec3(5, 6, 7)).norm(), 1e-12);
  const double half = std::numbers::sqrt2 / 2;
  EXPECT_LT((X_AB.q.coeffs() - Quat(half, 0, 0, half).coeffs()).norm(), 1e-12);
}

// Three points and their mirror image in the plane x = 0: a half turn about y does the same, and no mirror is needed.
TEST(RigidFit, TurnsPointsOfAPlaneInsteadOfMirroringThem) {
  const std::vector<Vec3> b{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, a{{-1, 0, 0}, {-2, 0, 0}, {-1, 1, 0}};
  const Pose X_AB = rigid_fit(a, b);
  EXPECT_NEAR(X_AB.q.toRotationMatrix().determinant(), 1.0, 1e-12);
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_LT((X_AB * b[i] - a[i]).norm(), 1e-12);
}

// By symmetry: a square that is larger all around is off by as much at each corner, whatever the turn or shift.
TEST(RigidFit, SpreadsWhatCannotBeMetOverThePoints) {
  const double off = 0.3;
  const std::vector<Vec3> b{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  std::vector<Vec3> a = b;
  for (Vec3& p : a) p *= 1.0 + off;
  const Pose X_AB = rigid_fit(a, b);
  for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR((X_AB * b[i] - a[i]).norm(), off, 1e-12);
}

// By hand: corners of a box of 6 by 4 by 2 are 3, 2 and 1 from its centre, eight of them: √8 times that.
TEST(RigidFit, MeasuresABoxALineAndAPlane) {
  std::vector<Vec3> box;
  for (const double x : {-3.0, 3.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-2.0, 2.0}) box.push_back(Vec3(10, 20, 30) + Vec3(x, y, z));
  EXPECT_LT((extents(box) - std::sqrt(8.0) * Vec3(3, 2, 1)).norm(), 1e-9);
  const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}};
  EXPECT_NEAR(extents(line)[1], 0.0, 1e-7);
  const std::vector<Vec3> plane{{0, 0, 1}, {2, 0, 1}, {0, 2, 1}};
  EXPECT_GT(extents(plane)[1], 1.0);
  EXPECT_NEAR(extents(plane)[2], 0.0, 1e-7);
}

}  // namespace
}  // namespace tractus::math
