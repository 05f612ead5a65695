/// Carving into a real L3, held against a segmentation that others made (tests/data/SOURCES.md).
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <filesystem>

#include "cases/carving.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {

using volume::Vec3;
using volume::Wall;

const std::filesystem::path kFolder =
    std::filesystem::path(checkout::kSource) / "tests/data/ct/tptbox_L3";

struct Vertebra {
  volume::Volume ct, parts, levels;
};

const Vertebra& vertebra() {
  static const auto read = [](const char* name) {
    auto in = volume_io::read_volume(kFolder / name);
    EXPECT_TRUE(in) << (in ? "" : in.error().what);
    return in->volume;
  };
  static const Vertebra loaded{read("sub-ct_label-22_ct.nii.gz"),
                               read("sub-ct_seg-subreg_label-22_msk.nii.gz"),
                               read("sub-ct_seg-vert_label-22_msk.nii.gz")};
  return loaded;
}

/// Label of the voxel a point lies in.
int label(const volume::Volume& mask, const Vec3& p) {
  const Vec3 at = mask.geometry.index_of(p);
  return int(std::lround(
      mask.value(int(std::lround(at.x())), int(std::lround(at.y())), int(std::lround(at.z())))));
}

cases::CarvingPlan plan(bool left) {
  cases::CarvingPlan p;
  p.entry_m = left ? Vec3(0.046, 0.200, -0.061) : Vec3(0.0025, 0.200, -0.0615);
  p.target_m = left ? Vec3(0.0385, 0.158, -0.061) : Vec3(0.010, 0.158, -0.061);
  p.spacing_m = 0.0015;  // as the CT: the places do not depend on it
  return p;
}

class EitherPedicle : public testing::TestWithParam<bool> {};

TEST_P(EitherPedicle, LeadsThroughTheArchIntoTheBody) {
  const auto carved =
      cases::carve(vertebra().ct, volume::TransferFunction::bone(), plan(GetParam()));
  ASSERT_TRUE(carved) << carved.error().what;
  EXPECT_EQ(carved->left_side(), GetParam());
  // Labels: 41 arch, 49 and 50 body. Between the spine's tip (label 42, mean x 21.9 mm) and the
  // body (mean x 26 mm).
  EXPECT_NEAR(carved->midline.at_m.x(), 0.024, 0.002);
  EXPECT_EQ(label(vertebra().parts, carved->tract.entry_m + 0.018 * carved->tract.axis), 41);
  EXPECT_EQ(label(vertebra().parts, carved->tract.end_m()), 50);
}

TEST_P(EitherPedicle, IsLeftBehindByEveryBreach) {
  for (const Wall wall : volume::kWalls) {
    auto p = plan(GetParam());
    p.breach = volume::BreachPlan{.wall = wall, .depth_m = 0.004};
    const auto carved = cases::carve(vertebra().ct, volume::TransferFunction::bone(), p);
    ASSERT_TRUE(carved) << carved.error().what;
    const auto& breach = *carved->breach;
    const Vec3 out = (breach.tip_m - breach.from_m).normalized();
    EXPECT_EQ(label(vertebra().levels, breach.centre_m - 0.0015 * out), 22)
        << volume::name(wall);                                                   // within L3
    EXPECT_EQ(label(vertebra().levels, breach.tip_m), 0) << volume::name(wall);  // out of all bone
    const int from = label(vertebra().parts, breach.centre_m - 0.0015 * out);
    EXPECT_TRUE(from == 41 || from == 49 || from == 50)
        << volume::name(wall) << ' ' << from;  // arch or body, no facet
  }
}

TEST_P(EitherPedicle, OpensIntoTheCanalWhenBreachedMedially) {
  auto p = plan(GetParam());
  p.breach = volume::BreachPlan{.wall = Wall::medial};
  const auto carved = cases::carve(vertebra().ct, volume::TransferFunction::bone(), p);
  ASSERT_TRUE(carved) << carved.error().what;
  // The canal: going on medially from the tip there is nothing but free space up to the midline.
  const Vec3 tip = carved->breach->tip_m;
  for (double d = 0.0; std::abs(carved->midline.left_of_plane_m(tip)) - d > 0.0; d += 0.001)
    EXPECT_EQ(label(vertebra().levels, tip + d * carved->tract.medial), 0) << d;
}

INSTANTIATE_TEST_SUITE_P(OfL3, EitherPedicle, testing::Bool(),
                         [](const auto& side) { return side.param ? "Left" : "Right"; });

}  // namespace
}  // namespace tractus
