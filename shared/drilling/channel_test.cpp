#include "drilling/channel.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "drilling/drilling_test_support.hpp"

namespace tractus {
namespace drilling {
namespace {

using math::Vec3;
using volume::Wall;

/// 1000 HU where `within` says so, 40 HU about it, 0.35 mm.
volume::Volume shaped(const std::function<bool(const Vec3&)>& within) {
  volume::Volume bone = block(91, 0.00035);
  for (int k = 0; k < 91; ++k)
    for (int j = 0; j < 91; ++j)
      for (int i = 0; i < 91; ++i) {
        const Vec3 p = bone.geometry.position_of({double(i), double(j), double(k)});
        bone.counts[bone.offset(i, j, k)] = within(p) ? 2024 : 1064;
      }
  return bone;
}

/// A bar along z: |x| < 6 mm, |y| < 4 mm, |z| < 12 mm.
volume::Volume bar() {
  return shaped([](const Vec3& p) {
    return std::abs(p.x()) < 0.006 && std::abs(p.y()) < 0.004 && std::abs(p.z()) < 0.012;
  });
}

/// A round bar along z: radius 5 mm, |z| < 12 mm.
volume::Volume rod() {
  return shaped(
      [](const Vec3& p) { return std::hypot(p.x(), p.y()) < 0.005 && std::abs(p.z()) < 0.012; });
}

/// Along the bar's middle, 18 mm long, from 2 mm within.
const volume::Tract kTract{.entry_m = Vec3(0, 0, -0.010),
                           .axis = Vec3::UnitZ(),
                           .length_m = 0.018,
                           .radius_m = 0.0015,
                           .medial = Vec3::UnitX(),
                           .superior = Vec3::UnitY()};
constexpr Burr kFast{.nose_m = 0.0, .rate_per_s = 300.0, .threshold_N = 0.0, .full_N = 1.0};

PilotHole drilled(const volume::Volume& bone, const Vec3& from, const Vec3& to) {
  const auto made = eroded(bone, kFast, stroke(0, from, to, 8000, 2.0f));
  EXPECT_TRUE(made);
  return channel_of(*made, volume::TransferFunction::bone(), kTract);
}

// The line from (1, −0.5, −12) to (1, −0.5, 6) mm, parallel to the tract: 1 mm medial, 0.5 mm
// inferior of it; deepest 10 mm + 6 mm + the ball's radius, less a voxel and the skin that
// lost less than half: s from the centre the front's dose is 300/s / (9 mm/s) (r − s − (r³ −
// s³)/3r²), a half at s = r − 0.16 mm.
TEST(PilotHole, OfAParallelPlungeIsOffsetAndNotTurned) {
  const PilotHole made = drilled(bar(), Vec3(0.001, -0.0005, -0.012), Vec3(0.001, -0.0005, 0.006));
  ASSERT_TRUE(made.entry_offset_m && made.angle_rad && made.depth_m);
  EXPECT_NEAR(made.entry_offset_m->x(), 0.001, 5e-5);
  EXPECT_NEAR(made.entry_offset_m->y(), -0.0005, 5e-5);
  EXPECT_NEAR(*made.angle_rad, 0.0, 0.005);
  EXPECT_LE(*made.depth_m, 0.016 + 0.0015);
  EXPECT_GE(*made.depth_m, 0.016 + 0.0015 - 0.00016 - 0.00035);
}

// 2 mm aside over 18 mm: atan(1/9) = 6.34°, and where it passes the entry's plane, z = −10 mm, it
// is 2/9 mm aside.
TEST(PilotHole, OfAnObliquePlungeHasItsAngle) {
  const PilotHole made = drilled(bar(), Vec3(0, 0, -0.012), Vec3(0.002, 0, 0.006));
  ASSERT_TRUE(made.entry_offset_m && made.angle_rad);
  EXPECT_NEAR(*made.angle_rad, std::atan(1.0 / 9.0), 0.01);
  EXPECT_NEAR(made.entry_offset_m->x(), 0.002 / 9.0, 1e-4);
}

// The bar's faces are 6 and 4 mm from the axis (in the image half a voxel uncertain), its end 4 mm
// ahead of the tract's.
TEST(PilotHole, LeavesTheBoneWhereTheBallReachesBeyondItsFace) {
  const PilotHole within = drilled(bar(), Vec3(0, 0, -0.012), Vec3(0, 0, 0.006));
  for (const Wall wall : {Wall::medial, Wall::lateral}) {
    ASSERT_TRUE(within.beyond_m[std::size_t(wall)]);
    EXPECT_NEAR(*within.beyond_m[std::size_t(wall)], 0.0015 - 0.006, 0.0004);
  }
  EXPECT_NEAR(within.beyond_m[std::size_t(Wall::superior)].value_or(0), 0.0015 - 0.004, 0.0004);
  EXPECT_FALSE(within.beyond_m[std::size_t(Wall::anterior)]);  // never ahead of the tract's end

  const PilotHole aside = drilled(bar(), Vec3(0, 0.0035, -0.012), Vec3(0, 0.0035, 0.006));
  EXPECT_NEAR(aside.beyond_m[std::size_t(Wall::superior)].value_or(0), 0.001, 0.0004);
  const PilotHole ahead = drilled(bar(), Vec3(0, 0, -0.012), Vec3(0, 0, 0.0125));
  EXPECT_NEAR(ahead.beyond_m[std::size_t(Wall::anterior)].value_or(0), 0.0125 + 0.0015 - 0.012,
              0.0005);
}

// The ball of 1.5 mm goes along 4.5 mm off the axis, half a right angle from medial to superior: it
// reaches 6 mm, and the rod's face is at 5 mm. No side wall lies that way.
TEST(PilotHole, IsFarthestBeyondTheCortexInAnyDirection) {
  const double aside = 0.0045 / std::numbers::sqrt2;
  const PilotHole made = drilled(rod(), Vec3(aside, aside, -0.012), Vec3(aside, aside, 0.006));
  ASSERT_TRUE(made.worst);
  EXPECT_NEAR(made.worst->beyond_m, 0.001, 0.0004);
  EXPECT_NEAR(made.worst->farthest_m.norm(), 0.006, 0.0004);
  EXPECT_NEAR(std::atan2(made.worst->farthest_m.y(), made.worst->farthest_m.x()),
              std::numbers::pi / 4.0, 0.1);
  EXPECT_NEAR(made.worst->cortex_m.norm(), 0.005, 0.0003);
  EXPECT_NEAR(made.worst->centre_m.x(), aside, 1e-4);
  EXPECT_NEAR(made.worst->radius_m, 0.0015, 0.0002);
  for (const math::Vec2& face : made.worst->outline_m) EXPECT_NEAR(face.norm(), 0.005, 0.0003);
  for (const auto& beyond_m : made.beyond_m) EXPECT_LT(beyond_m.value_or(-1.0), 0.0);
}

// From the axis to the ball's surface 1.5 mm, to the bar's nearest face 4 mm.
TEST(PilotHole, WithinTheCortexSaysWhatRemains) {
  const PilotHole made = drilled(bar(), Vec3(0, 0, -0.012), Vec3(0, 0, 0.006));
  ASSERT_TRUE(made.worst);
  EXPECT_NEAR(made.worst->beyond_m, 0.0015 - 0.004, 0.0004);
  EXPECT_NEAR(std::abs(made.worst->cortex_m.y()), 0.004, 0.0003);
  const core::Json json = made.to_json().at("worst");
  EXPECT_EQ(json.at("outline_m").size(), made.worst->outline_m.size());
  EXPECT_NEAR(json.at("beyond_m").get<double>(), made.worst->beyond_m, 1e-6);
}

TEST(PilotHole, OfAHoleHasNoDirectionAndOfNothingHasNothing) {
  const PilotHole hole = drilled(bar(), Vec3(0, 0, 0.000), Vec3(0, 0, 0.001));
  EXPECT_GT(hole.voxels, 100u);
  EXPECT_FALSE(hole.angle_rad);
  EXPECT_TRUE(hole.depth_m);
  const PilotHole nothing = drilled(bar(), Vec3(0, 0, -0.019), Vec3(0, 0, -0.0189));
  EXPECT_FALSE(nothing.depth_m);
  EXPECT_TRUE(nothing.to_json().at("beyond_m").at("medial").is_null());
  EXPECT_FALSE(nothing.worst);
  EXPECT_TRUE(nothing.to_json().at("worst").is_null());
}

}  // namespace
}  // namespace drilling
}  // namespace tractus
