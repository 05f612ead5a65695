#include "cases/carving.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace cases {
namespace {

using volume::Vec3;
using volume::Wall;

/// A made vertebra, mirrored about x = 0: a body with a shell of 2 mm, two hollow pedicles with
/// walls of 2 mm (centred 17 mm off the midline, 10 mm wide, 14 mm high), a spine. Its left pedicle
/// runs from y = 22 mm into the body at y = −8 mm.
double made_vertebra(const Vec3& p_m) {
  const Vec3 p = p_m * 1e3;
  const double u = std::abs(p.x()), off = std::abs(u - 17), z = std::abs(p.z());
  const double body = std::hypot(u / 25, (p.y() + 22) / 17);
  const bool in_body = body < 1 && z < 13,
             marrow = std::hypot(u / 23, (p.y() + 22) / 15) < 1 && z < 11;
  const bool pedicle = off < 5 && z < 7 && p.y() > -14 && p.y() < 22;
  const bool core = off < 3 && z < 5 && p.y() > -16 && p.y() < 20;
  const bool spine = u < 3 && p.y() > 16 && p.y() < 40 && z < 8;
  if (core || (marrow && !pedicle)) return 60;
  return in_body || pedicle || spine ? 900 : 20;
}

/// The vertebra in the middle of much else: far from it, a slab of bone on every side.
volume::Volume made_ct(double half_x_mm, double half_y_mm, double half_z_mm) {
  volume::Volume v{.geometry = {{int(2 * half_x_mm), int(2 * half_y_mm), int(2 * half_z_mm)},
                                Vec3::Constant(0.001),
                                Vec3(0.0005 - half_x_mm * 1e-3, 0.0005 - half_y_mm * 1e-3,
                                     0.0005 - half_z_mm * 1e-3),
                                volume::Mat3::Identity()},
                   .slope = 1,
                   .intercept = -1024,
                   .counts = {}};
  const auto& dims = v.geometry.dims;
  for (int k = 0; k < dims[2]; ++k)
    for (int j = 0; j < dims[1]; ++j)
      for (int i = 0; i < dims[0]; ++i) {
        const Vec3 p = v.geometry.position_of(Vec3(i, j, k));
        const bool far = std::abs(p.x()) > 0.115 || std::abs(p.y()) > 0.090;
        v.counts.push_back(v.count_of(far ? 1200.0 : made_vertebra(p)));
      }
  return v;
}

CarvingPlan plan() {
  return {.entry_m = {0.017, 0.024, 0.0},
          .target_m = {0.017, -0.016, 0.0},
          .breach = volume::BreachPlan{.wall = Wall::medial}};
}

volume::Volume part_of(const volume::Volume& whole, const volume::Box& box) {
  volume::Volume out{
      .geometry = whole.geometry, .slope = whole.slope, .intercept = whole.intercept, .counts = {}};
  for (std::size_t a = 0; a < 3; ++a) out.geometry.dims[a] = box.end[a] - box.begin[a];
  out.geometry.origin_m =
      whole.geometry.position_of(Vec3(box.begin[0], box.begin[1], box.begin[2]));
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i)
        out.counts.push_back(whole.counts[whole.offset(i, j, k)]);
  return out;
}

TEST(Place, FindsTheWallsThatTheVertebraWasMadeWith) {
  const auto ct = made_ct(60, 60, 40);
  const auto placed = place(ct, volume::TransferFunction::bone(), plan());
  ASSERT_TRUE(placed) << placed.error().what;
  EXPECT_TRUE(placed->left_side()) << "x grows to the patient's left";
  for (const std::size_t side : {0u, 1u, 2u, 3u}) {
    const auto& wall = placed->walls[side];
    ASSERT_TRUE(wall) << wall.error().what;
    // Made 2 mm thick, 3 mm (sides) or 5 mm (above, below) from the axis; voxels of 1 mm.
    EXPECT_NEAR(wall->thickness_m(), 0.002, 0.0007) << side;
    EXPECT_NEAR(wall->inner_m, side < 2 ? 0.003 : 0.005, 0.0007) << side;
  }
  ASSERT_TRUE(placed->breach);
  EXPECT_LT(placed->breach->tip_m.x(), 0.017 - 0.005) << "medial is towards x = 0";
}

TEST(Place, IsWhereCarveDrills) {
  const auto ct = made_ct(60, 60, 40);
  const auto transfer = volume::TransferFunction::bone();
  const auto placed = place(ct, transfer, plan());
  const auto carved = carve(ct, transfer, plan());
  ASSERT_TRUE(placed && carved);
  EXPECT_EQ(placed->tract.medial, carved->tract.medial);
  EXPECT_EQ(placed->breach->centre_m, carved->breach->centre_m);
  EXPECT_EQ(placed->breach->wall.thickness_m(), carved->breach->wall.thickness_m());
}

TEST(BoxThatMatters, LeavesOutOnlyWhatChangesNothing) {
  const auto whole = made_ct(130, 100, 70);
  const auto box = box_that_matters(whole.geometry, plan().entry_m, plan().target_m);
  ASSERT_TRUE(box) << box.error().what;
  const auto part = part_of(whole, *box);
  ASSERT_LT(part.counts.size(), whole.counts.size());
  const auto transfer = volume::TransferFunction::bone();
  const auto of_whole = carve(whole, transfer, plan()), of_part = carve(part, transfer, plan());
  ASSERT_TRUE(of_whole && of_part);
  EXPECT_NEAR((of_whole->midline.at_m - of_part->midline.at_m).norm(), 0.0, 1e-12);
  EXPECT_NEAR((of_whole->breach->tip_m - of_part->breach->tip_m).norm(), 0.0, 1e-12);
  ASSERT_EQ(of_whole->volume.counts.size(), of_part->volume.counts.size());
  int worst = 0;  // of the CT value: the grids' origins differ in their last bits
  for (std::size_t n = 0; n < of_part->volume.counts.size(); ++n)
    worst =
        std::max(worst, std::abs(int(of_whole->volume.counts[n]) - int(of_part->volume.counts[n])));
  EXPECT_LE(worst, 1);
}

TEST(BoxThatMatters, SaysThatATractElsewhereMeetsNothingOfTheVolume) {
  const auto ct = made_ct(20, 20, 20);
  const auto box = box_that_matters(ct.geometry, {1.0, 1.0, 1.0}, {1.0, 0.96, 1.0});
  ASSERT_FALSE(box);
  EXPECT_EQ(box.error().code, core::Errc::out_of_range);
}

}  // namespace
}  // namespace cases
}  // namespace tractus
