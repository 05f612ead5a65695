#include "volume/anatomy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "volume/resample.hpp"

namespace tractus {
namespace volume {
namespace {

using testing::HasSubstr;
constexpr double kDegree = std::numbers::pi / 180;

/// A made vertebra, mirror-symmetric about a plane through (x0, 20 mm) turned by `turn`: body, two
/// pedicles, a spine, and two transverse processes. Local u is left of the plane, y is posterior;
/// mm.
Volume vertebra(double x0_mm, double turn_rad, double spacing_mm) {
  Volume v{.geometry = {}, .slope = 1, .intercept = -1024, .counts = {}};
  v.geometry.spacing_m = Vec3::Constant(spacing_mm * 1e-3);
  v.geometry.dims = {int(120 / spacing_mm), int(110 / spacing_mm), int(50 / spacing_mm)};
  v.geometry.origin_m = Vec3(x0_mm - 57, -60, -25) * 1e-3;
  v.counts.resize(v.geometry.voxel_count());
  for (int k = 0; k < v.geometry.dims[2]; ++k)
    for (int j = 0; j < v.geometry.dims[1]; ++j)
      for (int i = 0; i < v.geometry.dims[0]; ++i) {
        const Vec3 p = v.geometry.position_of(Vec3(i, j, k)) * 1e3 - Vec3(x0_mm, 20, 0);
        const double u = std::abs(p.x() * std::cos(turn_rad) + p.y() * std::sin(turn_rad));
        const double y = -p.x() * std::sin(turn_rad) + p.y() * std::cos(turn_rad) + 20;
        const bool body = std::hypot(u / 23, (y + 16) / 16) < 1 && std::abs(p.z()) < 13;
        const bool pedicle = u > 12 && u < 21 && y > -8 && y < 22 && std::abs(p.z()) < 7;
        const bool spine = u < 3 && y > 20 && y < 45 && std::abs(p.z()) < 9;
        const bool process = u > 20 && u < 34 && y > 12 && y < 19 && std::abs(p.z()) < 5;
        v.counts[v.offset(i, j, k)] = v.count_of(body || pedicle || spine || process ? 600 : 30);
      }
  return v;
}

TEST(Midline, IsFoundFromEitherPedicleOfAVertebraThatLiesAskew) {
  for (const double turn : {0.0, 5 * kDegree, -8 * kDegree}) {
    const Volume volume = vertebra(31.0, turn, 1.5);
    for (const double side : {1.0, -1.0}) {
      const Vec3 entry = Vec3(31 + side * 17, 20, 0) * 1e-3,
                 target = Vec3(31 + side * 12, -20, 0) * 1e-3;
      const auto plane = midline_about(volume, TransferFunction::bone(), entry, target);
      ASSERT_TRUE(plane) << plane.error().what;
      EXPECT_NEAR(plane->at_m.x() * 1e3, 31.0, 1.0)
          << turn;  // the plane passes (31, 20) and the entry lies at y = 20
      EXPECT_NEAR(plane->turn_rad / kDegree, turn / kDegree, 1.5);
      EXPECT_GT(*plane->symmetry, 0.9);
      EXPECT_EQ(plane->left_of_plane_m(entry) > 0, side > 0);
    }
  }
}

TEST(Midline, IsRefusedWhereNothingIsSymmetric) {
  Volume volume = vertebra(0, 0, 1.5);
  std::ranges::fill(volume.counts, volume.count_of(30));
  const auto plane =
      midline_about(volume, TransferFunction::bone(), {0.017, 0.02, 0}, {0.012, -0.02, 0});
  ASSERT_FALSE(plane);
  EXPECT_THAT(plane.error().what, HasSubstr("state it"));
}

TEST(Tract, HasMedialTowardsTheMidlineOnEitherSide) {
  const auto midline = stated_midline(0.0, Vec3::Zero());
  const auto left = tract_between({0.02, 0.03, 0}, {0.02, 0, 0}, 0.03, 0.0015, midline);
  const auto right = tract_between({-0.02, 0.03, 0}, {-0.02, 0, 0}, 0.03, 0.0015, midline);
  ASSERT_TRUE(left && right);
  EXPECT_TRUE(left->medial.isApprox(
      Vec3(-1, 0, 0)));  // LPS: x to the left, so medial of a left pedicle is −x
  EXPECT_TRUE(right->medial.isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(left->superior.isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(right->superior.isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(left->axis.isApprox(Vec3(0, -1, 0)));  // anterior
}

TEST(Tract, TurnsItsWallsWithTheAxis) {
  // Left pedicle, converging 10° and pointing 20° down; by hand: axis = (−cos20 sin10, −cos20
  // cos10, −sin20).
  const double c = 10 * kDegree, d = 20 * kDegree;
  const Vec3 axis(-std::cos(d) * std::sin(c), -std::cos(d) * std::cos(c), -std::sin(d)),
      entry(0.03, 0.03, 0);
  const auto tract =
      tract_between(entry, entry + 0.04 * axis, 0.03, 0.0015, stated_midline(0, entry));
  ASSERT_TRUE(tract);
  EXPECT_TRUE(tract->axis.isApprox(axis));
  EXPECT_NEAR(tract->medial.dot(tract->axis), 0, 1e-12);
  EXPECT_NEAR(tract->superior.dot(tract->medial), 0, 1e-12);
  const Vec3 x(-1, 0, 0);
  EXPECT_TRUE(tract->medial.isApprox((x - x.dot(axis) * axis).normalized()));
  EXPECT_GT(tract->superior.z(), 0.9);
}

TEST(Tract, IsRefusedWhenItHasNoSideNoLengthOrNoSuchWalls) {
  const auto why = [](const Vec3& entry, const Vec3& target, double length, double radius) {
    const auto tract = tract_between(entry, target, length, radius, stated_midline(0, entry));
    return tract ? "taken" : tract.error().what;
  };
  const Vec3 a(0.02, 0.03, 0), b(0.02, 0, 0);
  EXPECT_EQ(why(a, b, 0.03, 0.0015), "taken");
  EXPECT_THAT(why({0.001, 0.03, 0}, {0.001, 0, 0}, 0.03, 0.0015),
              HasSubstr("1.0 mm from the midline"));
  EXPECT_THAT(why(a, a, 0.03, 0.0015), HasSubstr("same point"));
  EXPECT_THAT(why(a, b, 0.0, 0.0015), HasSubstr("length 0"));
  EXPECT_THAT(why(a, b, 0.03, -1), HasSubstr("radius -1"));
  EXPECT_THAT(why(a, {std::nan(""), 0, 0}, 0.03, 0.0015), HasSubstr("finite"));
  EXPECT_THAT(why(a, b, std::numeric_limits<double>::infinity(), 0.0015), HasSubstr("finite"));
  EXPECT_THAT(why(a, a + Vec3(0, 0, 0.03), 0.03, 0.0015), HasSubstr("no such names"));
}

/// A volume whose counts are a polynomial of the voxel index.
template <class F>
Volume polynomial(F&& f, const Mat3& directions = Mat3::Identity()) {
  Volume v{.geometry = {{12, 11, 10}, {0.0015, 0.001, 0.002}, {0.01, 0.02, 0.03}, directions},
           .slope = 0.5,
           .intercept = -100,
           .counts = {}};
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 11; ++j)
      for (int i = 0; i < 12; ++i)
        v.counts.push_back(std::uint16_t(f(double(i), double(j), double(k))));
  return v;
}

TEST(Resample, KeepsAQuadraticAndItsPlace) {
  // Cubic convolution with a = −1/2 reproduces polynomials up to degree 2; counts are whole, so to
  // half a count.
  const auto f = [](double i, double j, double k) {
    return 1000 + 7 * i + 3 * i * i + 5 * j * j - 2 * k * k + 4 * k;
  };
  Mat3 directions;
  directions << 0, 0, -1, 1, 0, 0, 0, 1, 0;
  const Volume source = polynomial(f, directions);
  const auto fine = resample_finer(source, {{2, 2, 2}, {9, 9, 8}}, 0.0004);
  ASSERT_TRUE(fine) << fine.error().what;
  EXPECT_EQ(fine->geometry.dims,
            (std::array<int, 3>{23, 16, 26}));  // 6·1.5/0.4 = 22.5, 6·1/0.4 = 15, 5·2/0.4 = 25
  for (int k = 0; k < 26; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 23; ++i) {
        const Vec3 at = source.geometry.index_of(fine->geometry.position_of(Vec3(i, j, k)));
        ASSERT_NEAR(fine->counts[fine->offset(i, j, k)], f(at.x(), at.y(), at.z()), 0.51)
            << i << ' ' << j << ' ' << k;
      }
  EXPECT_EQ(fine->slope, 0.5);
  EXPECT_EQ(fine->intercept, -100.0);
}

TEST(Resample, LeavesAnAxisThatIsFineEnoughAsItIs) {
  const Volume source =
      polynomial([](double i, double j, double k) { return (i * 37 + j * 91 + k * 53) * 7; });
  const auto same = resample_finer(source, {{0, 0, 0}, {12, 11, 10}}, 0.002);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->counts, source.counts);
  EXPECT_EQ(same->geometry.spacing_m, source.geometry.spacing_m);
}

TEST(Resample, RefusesAGridThatIsTooLargeOrEmpty) {
  const Volume source = polynomial([](double, double, double) { return 1; });
  EXPECT_EQ(resample_finer(source, {{0, 0, 0}, {12, 11, 10}}, 1e-5).error().code,
            core::Errc::too_large);
  EXPECT_EQ(resample_finer(source, {{0, 0, 0}, {12, 11, 10}}, 0.0).error().code,
            core::Errc::bad_input);
  EXPECT_EQ(resample_finer(source, {{3, 3, 3}, {3, 4, 4}}, 0.001).error().code,
            core::Errc::bad_input);
  EXPECT_EQ(resample_finer(source, {{0, 0, 0}, {13, 4, 4}}, 0.001).error().code,
            core::Errc::bad_input);
}

TEST(BoxAbout, HoldsThePointsWithTheirMarginAndStaysInside) {
  const Geometry g{{100, 100, 100}, Vec3::Constant(0.001), Vec3::Zero(), Mat3::Identity()};
  const std::array points{Vec3(0.010, 0.050, 0.095), Vec3(0.020, 0.050, 0.095)};
  const Box box = box_about(g, points, 0.0123);
  EXPECT_EQ(box.begin, (std::array{0, 37, 82}));  // 50 − 12.3 = 37.7, 95 − 12.3 = 82.7
  EXPECT_EQ(box.end, (std::array{34, 64, 100}));  // 32.3 → 33, 62.3 → 63, past the edge
}

}  // namespace
}  // namespace volume
}  // namespace tractus
