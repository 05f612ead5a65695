#include "volume/carve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "volume/anatomy.hpp"
#include "volume/resample.hpp"

namespace tractus {
namespace volume {
namespace {

using testing::HasSubstr;

constexpr double kMm = 1e-3;

/// Voxels of a scene given in V, m: each the mean over 3³ points within it, as a scanner's are.
Volume rendered(const Geometry& geometry, const std::function<double(const Vec3&)>& value) {
  Volume out{.geometry = geometry, .slope = 1.0, .intercept = -1024.0, .counts = {}};
  out.counts.resize(geometry.voxel_count());
  for (int k = 0; k < geometry.dims[2]; ++k)
    for (int j = 0; j < geometry.dims[1]; ++j)
      for (int i = 0; i < geometry.dims[0]; ++i) {
        double sum = 0.0;
        for (int part = 0; part < 27; ++part)
          sum += value(geometry.position_of(
              Vec3(i, j, k) + Vec3(part % 3 - 1, part / 3 % 3 - 1, part / 9 - 1) / 3.0));
        out.counts[out.offset(i, j, k)] = out.count_of(sum / 27);
      }
  return out;
}

/// A grid about (0, 0, 0) that covers ± `half_mm` along its own axes.
Geometry grid(const Vec3& half_mm, double spacing_mm, const Mat3& directions = Mat3::Identity()) {
  Geometry g;
  for (int a = 0; a < 3; ++a)
    g.dims[std::size_t(a)] = 1 + 2 * int(std::ceil(half_mm[a] / spacing_mm));
  g.spacing_m = Vec3::Constant(spacing_mm * kMm);
  g.directions = directions;
  const Vec3 middle(g.dims[0] - 1, g.dims[1] - 1, g.dims[2] - 1);
  g.origin_m = -(directions * (middle.cwiseProduct(g.spacing_m) / 2));
  return g;
}

Mat3 turned(double degrees, const Vec3& about) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, about.normalized()).toRotationMatrix();
}

/// A left pedicle as a pipe of 1000 HU along y: cavity |x − 20| < 5, |z| < 6, walls 2 mm thick, the
/// medial one 1.2 mm where −8 < y < −2; open at y = 15, a plug from y = −15 to −18. Soft tissue 40
/// HU about it. All in mm.
double pipe(const Vec3& p_m) {
  const Vec3 p = p_m / kMm;
  const double x = p.x() - 20.0;
  const double medial = p.y() > -8 && p.y() < -2 ? 6.2 : 7.0;
  const bool within = x > -medial && x < 7 && std::abs(p.z()) < 8 && p.y() < 15 && p.y() > -18;
  const bool cavity = std::abs(x) < 5 && std::abs(p.z()) < 6 && p.y() > -15;
  return within && !cavity ? 1000.0 : 40.0;
}

Geometry pipe_grid(double spacing_mm, const Mat3& directions = Mat3::Identity(),
                   const Vec3& half_mm = {14, 25, 14}) {
  Geometry g = grid(half_mm, spacing_mm, directions);
  g.origin_m += Vec3(20 * kMm, 0, 0);
  return g;
}

/// Along −y in the pipe's middle, from y = 12 to y = −12 mm.
Tract pipe_tract() {
  return *tract_between({20 * kMm, 12 * kMm, 0}, {20 * kMm, -20 * kMm, 0}, 24 * kMm, 1.5 * kMm,
                        stated_midline(0.0, {20 * kMm, 12 * kMm, 0}));
}

class APipe : public testing::TestWithParam<std::tuple<double, Mat3>> {};

TEST_P(APipe, HasItsThinnestMedialWallWhereItWasMadeThin) {
  const auto& [spacing_mm, directions] = GetParam();
  const Volume volume = rendered(pipe_grid(spacing_mm, directions), pipe);
  const auto transfer = TransferFunction::bone();
  const WallFinder finder(volume, transfer);
  const auto found = finder.thinnest(pipe_tract(), Wall::medial);
  ASSERT_TRUE(found) << found.error().what;
  const double half_voxel = spacing_mm / 2;
  EXPECT_NEAR(found->thickness_m() / kMm, 1.2, half_voxel);
  EXPECT_NEAR(found->inner_m / kMm, 5.0, half_voxel);
  EXPECT_GT(found->at_m / kMm,
            14.0 - 1.5);  // y = −2 is 14 mm deep, −8 is 20 mm; a bundle of rays is 2.1 mm wide
  EXPECT_LT(found->at_m / kMm, 20.0 + 1.5);
  const auto lateral = finder.thinnest(pipe_tract(), Wall::lateral),
             superior = finder.thinnest(pipe_tract(), Wall::superior);
  ASSERT_TRUE(lateral && superior);
  EXPECT_NEAR(lateral->thickness_m() / kMm, 2.0, half_voxel);
  EXPECT_NEAR(superior->inner_m / kMm, 6.0, half_voxel);
  EXPECT_NEAR(superior->thickness_m() / kMm, 2.0, half_voxel);
  const auto all = finder.thinnest(pipe_tract());
  ASSERT_EQ(all.size(), kWalls.size());
  for (std::size_t w = 0; w < all.size(); ++w) {
    const auto one = finder.thinnest(pipe_tract(), kWalls[w]);
    ASSERT_EQ(bool(all[w]), bool(one));
    if (!one) continue;
    EXPECT_EQ(all[w]->at_m, one->at_m);
    EXPECT_EQ(all[w]->thickness_m(), one->thickness_m());
  }
}

INSTANTIATE_TEST_SUITE_P(
    GridsFineCoarseTurnedAndLeftHanded, APipe,
    testing::Values(std::tuple(0.35, Mat3::Identity()), std::tuple(0.6, Mat3::Identity()),
                    std::tuple(0.35, turned(25, {1, 2, 3})),
                    std::tuple(0.5, Mat3(turned(90, {0, 1, 0}) * Vec3(1, 1, -1).asDiagonal()))));

TEST(Breach, LiesInTheWallAndReachesBeyondIt) {
  const Volume volume = rendered(pipe_grid(0.35), pipe);
  const auto transfer = TransferFunction::bone();
  const auto breach =
      place_breach(volume, transfer, pipe_tract(), {.wall = Wall::medial, .depth_m = 3 * kMm});
  ASSERT_TRUE(breach) << breach.error().what;
  EXPECT_NEAR(breach->centre_m.x() / kMm, 20 - 5.6, 0.2);  // middle of a wall from 5.0 to 6.2 mm
  EXPECT_NEAR(breach->tip_m.x() / kMm, 20 - 6.2 - 3, 0.2);
  EXPECT_NEAR(breach->tip_m.z() / kMm, 0, 1e-9);
}

TEST(Breach, GoesThroughTheEndWhenAnterior) {
  const Volume volume = rendered(pipe_grid(0.35), pipe);
  const auto transfer = TransferFunction::bone();
  const auto breach =
      place_breach(volume, transfer, pipe_tract(), {.wall = Wall::anterior, .depth_m = 4 * kMm});
  ASSERT_TRUE(breach) << breach.error().what;
  EXPECT_NEAR(breach->wall.thickness_m() / kMm, 3.0, 0.2);  // plug from −15 to −18
  EXPECT_NEAR(breach->centre_m.y() / kMm, -16.5, 0.2);
  EXPECT_NEAR(breach->tip_m.y() / kMm, -22.0, 0.2);
}

TEST(Breach, LiesWhereAPersonSaysWhenHeSays) {
  const Volume volume = rendered(pipe_grid(0.35), pipe);
  const auto transfer = TransferFunction::bone();
  const auto breach = place_breach(volume, transfer, pipe_tract(),
                                   {.wall = Wall::medial, .depth_m = kMm, .at_m = 8 * kMm});
  ASSERT_TRUE(breach);
  EXPECT_NEAR(breach->centre_m.y() / kMm, 4.0, 1e-9);
  EXPECT_NEAR(breach->wall.thickness_m() / kMm, 2.0, 0.175);
}

TEST(Breach, IsRefusedWithAClearWordWhereItCannotBe) {
  const auto transfer = TransferFunction::bone();
  const auto why = [&](const std::function<double(const Vec3&)>& scene, const BreachPlan& plan) {
    const auto breach =
        place_breach(rendered(pipe_grid(1.2, Mat3::Identity(), {30, 36, 30}), scene), transfer,
                     pipe_tract(), plan);
    return breach ? "placed" : breach.error().what;
  };
  const auto soft = [](const Vec3&) { return 40.0; };
  const auto solid = [](const Vec3&) { return 1000.0; };
  EXPECT_THAT(why(soft, {.wall = Wall::medial, .at_m = 0.01}),
              HasSubstr("medial: there is no bone within 25 mm"));
  EXPECT_THAT(why(solid, {.wall = Wall::superior, .at_m = 0.01}),
              HasSubstr("superior: the bone is never left within 25 mm"));
  EXPECT_THAT(why(solid, {.wall = Wall::anterior}),
              HasSubstr("anterior: the volume ends before the wall is left"));
  EXPECT_THAT(why(soft, {.wall = Wall::lateral}), HasSubstr("no part of the tract is enclosed"));
  EXPECT_THAT(why(pipe, {.wall = Wall::medial, .depth_m = 0.0}),
              HasSubstr("must be a positive length"));
  EXPECT_THAT(why(pipe, {.wall = Wall::medial, .depth_m = std::nan("")}),
              HasSubstr("must be a positive length"));
  EXPECT_THAT(why(pipe, {.wall = Wall::medial, .at_m = 0.03}), HasSubstr("not along the tract"));
  EXPECT_THAT(why(pipe, {.wall = Wall::anterior, .at_m = 0.01}), HasSubstr("no other place"));
  EXPECT_THAT(why(pipe, {.wall = Wall::lateral, .depth_m = 24 * kMm}),
              HasSubstr("leaves the volume"));
}

/// CT values lost, as a volume of full bone, m³.
double removed_m3(const Volume& before, const Volume& after) {
  double sum = 0.0;
  for (std::size_t n = 0; n < before.counts.size(); ++n) sum += before.counts[n] - after.counts[n];
  return sum / 1000.0 * before.geometry.spacing_m.prod();
}

TEST(Drill, RemovesTheVolumeOfACylinder) {
  for (const Mat3& directions : {Mat3(Mat3::Identity()), turned(30, {1, 1, 0.3})}) {
    Volume block =
        rendered(grid({12, 20, 12}, 0.35, directions), [](const Vec3&) { return 1000.0; });
    const Volume before = block;
    const auto tract = tract_between({5 * kMm, 9 * kMm, kMm}, {0, -9 * kMm, 0}, 16 * kMm, 1.5 * kMm,
                                     stated_midline(0, Vec3::Zero()));
    drill(block, *tract, 2 * kMm, std::nullopt, 0.0);
    const double expected =
        std::numbers::pi * 1.5 * 1.5 * (16 + 2) * kMm * kMm * kMm;  // π r² (length + mouth)
    EXPECT_NEAR(removed_m3(before, block) / expected, 1.0, 0.005);
    EXPECT_NEAR(block.value_at(tract->entry_m + 0.008 * tract->axis), 0.0, 1e-9);
    EXPECT_NEAR(block.value_at(tract->entry_m + 0.008 * tract->axis + 0.0022 * tract->medial),
                1000.0, 1e-9);
  }
}

TEST(Drill, AddsARoundedBreachBeyondTheEnd) {
  Volume block = rendered(grid({8, 20, 8}, 0.35), [](const Vec3&) { return 1000.0; });
  const Volume before = block;
  const auto tract = tract_between({5 * kMm, 10 * kMm, 0}, {5 * kMm, -9 * kMm, 0}, 10 * kMm,
                                   1.5 * kMm, stated_midline(0, Vec3::Zero()));
  Breach breach{.wall = {.wall = Wall::anterior}, .depth_m = 3 * kMm, .from_m = tract->end_m()};
  breach.tip_m = tract->end_m() + 6 * kMm * tract->axis;
  drill(block, *tract, 0.0, breach, 0.0);
  // π r² (10 + 6 − 1.5) and half a ball of r
  const double expected = std::numbers::pi * (2.25 * 14.5 + 2.0 / 3.0 * 3.375) * 1e-9;
  EXPECT_NEAR(removed_m3(before, block) / expected, 1.0, 0.005);
}

/// To the last count what the whole bone drilled once more would be, and back.
TEST(Redrill, IsWhatDrillingTheWholeBoneGives) {
  const Volume bone = rendered(grid({8, 20, 8}, 0.35, turned(20, {1, 0.4, 0.3})),
                               [](const Vec3& p) { return 400.0 + 2e4 * p.x() + 3e4 * p.y(); });
  const auto tract = tract_between({5 * kMm, 10 * kMm, 0}, {2 * kMm, -9 * kMm, 2 * kMm}, 14 * kMm,
                                   1.5 * kMm, stated_midline(0, Vec3::Zero()));
  Volume whole = bone;
  drill(whole, *tract, kMm, std::nullopt, 0.0);
  Breach side{.wall = {.wall = Wall::lateral}, .depth_m = 3 * kMm};
  side.from_m = tract->entry_m + 7 * kMm * tract->axis;
  side.tip_m = side.from_m - 6 * kMm * tract->medial;
  Breach end{.wall = {.wall = Wall::anterior}, .depth_m = 3 * kMm, .from_m = tract->end_m()};
  end.tip_m = tract->end_m() + 5 * kMm * tract->axis;
  for (const Breach& breach : {side, end}) {
    Volume expected = bone, again = whole;
    drill(expected, *tract, kMm, breach, 0.0);
    ASSERT_NE(expected.counts, whole.counts);
    redrill(again, bone, *tract, kMm, breach, true, 0.0);
    EXPECT_EQ(again.counts, expected.counts);
    redrill(again, bone, *tract, kMm, breach, false, 0.0);
    EXPECT_EQ(again.counts, whole.counts);
  }
}

TEST(Drill, MovesVoxelsAtTheWallByTheShareRemoved) {
  Volume block = rendered(grid({6, 6, 6}, 0.4), [](const Vec3&) { return 1000.0; });
  // Flat end at y = 0.1 mm: the voxel centred at y = 0 spans −0.2 … 0.2, a quarter of it is
  // removed.
  const auto tract = tract_between({0.004, 0.0051, 0}, {0.004, -0.005, 0}, 0.005, 0.0015,
                                   stated_midline(0, Vec3::Zero()));
  const Geometry& g = block.geometry;
  drill(block, *tract, 0.0, std::nullopt, 0.0);
  EXPECT_NEAR(block.value((g.dims[0] - 1) / 2 + 10, (g.dims[1] - 1) / 2, (g.dims[2] - 1) / 2),
              750.0, 1.0);
}

TEST(Drill, NeverRaisesAValueAndLeavesNoOpacity) {
  Volume air = rendered(grid({6, 6, 6}, 0.5), [](const Vec3&) { return -900.0; });
  const Volume before = air;
  const auto tract = tract_between({0.004, 0.005, 0}, {0.004, -0.005, 0}, 0.008, 0.0015,
                                   stated_midline(0, Vec3::Zero()));
  drill(air, *tract, 0.0, std::nullopt, 0.0);
  EXPECT_EQ(air.counts, before.counts);
}

TEST(EmptyValue, IsWaterUnlessWaterWouldBeFelt) {
  const Volume volume = rendered(grid({2, 2, 2}, 1), [](const Vec3&) { return 0.0; });
  EXPECT_EQ(*empty_value(volume, TransferFunction::bone()), 0.0);
  EXPECT_EQ(*empty_value(volume, *TransferFunction::make({{-500, 0}, {300, 1}})), -500.0);
  EXPECT_FALSE(empty_value(volume, *TransferFunction::make({{-500, 0.1}, {300, 1}})));
  EXPECT_FALSE(empty_value(
      volume, *TransferFunction::make({{-5000, 0}, {300, 1}})));  // counts begin at −1024
}

TEST(Mouth, ReachesAsFarBackAsTheBone) {
  const Volume volume =
      rendered(pipe_grid(0.5), [](const Vec3& p) { return p.y() < 0.015 ? 1000.0 : 40.0; });
  const auto transfer = TransferFunction::bone();
  EXPECT_NEAR(WallFinder(volume, transfer).behind_entry_m(pipe_tract()), 3 * kMm,
              0.5 * kMm);  // entry at y = 12 mm
}

}  // namespace
}  // namespace volume
}  // namespace tractus
