/// What the eyes see, in pixels, against what they must see by hand.
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <numbers>

#include "tests/support/openxr/headset_fixture.hpp"

namespace tractus {
namespace headset {
namespace {

/// Middle of the red ball at the tip, from the lower left corner; how many pixels it has.
struct Ball {
  double x_px = 0.0, y_px = 0.0;
  int pixels = 0;
};

Ball ball_in(const std::filesystem::path& png) {
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(png.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  Ball out;
  for (int y = 0; y < image->GetDimensions()[1]; ++y)
    for (int x = 0; x < image->GetDimensions()[0]; ++x) {
      const double red = image->GetScalarComponentAsDouble(x, y, 0, 0);
      const double green = image->GetScalarComponentAsDouble(x, y, 0, 1);
      if (red < 60 || red < 2.0 * green) continue;
      out.x_px += x + 0.5, out.y_px += y + 0.5;
      ++out.pixels;
    }
  out.x_px /= out.pixels, out.y_px /= out.pixels;
  return out;
}

class Pictures : public WithRuntime {
 protected:
  /// Both eyes' pictures of a frame some way on.
  std::array<Ball, 2> seen(Headset& headset) {
    const std::uint64_t frame = control_->frames + 3;
    control_->keep_at = frame;
    EXPECT_TRUE(step_to(headset, *control_, frame));
    return {ball_in(folder_ / "left.png"), ball_in(folder_ / "right.png")};
  }
};

// By hand: half angles 0.75 rad outwards (tangent 0.931596), 0.65 inwards (0.760204), 0.7 up and
// down (0.842288); eyes 64 mm apart at (0, 1.6, 0), looking along -z; 320 x 320 pixels.
// Near, at (0.05, 1.5, -0.4):  left  0.082/0.4 = 0.205, 320 (0.205 + 0.931596)/1.691800 = 214.98
//                              right 0.018/0.4 = 0.045, 320 (0.045 + 0.760204)/1.691800 = 152.30
//                              up   -0.1/0.4 = -0.25,   320 (-0.25 + 0.842288)/1.684577 = 112.51
// Twice as far, at (0.05, 1.5, -0.8): left 195.60, right 148.05, up 136.26.
TEST_F(Pictures, ANearPointLiesFurtherApartThanAFarOneAndWhereGeometryPutsBoth) {
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 5));
  const auto near = seen(*headset);
  EXPECT_GT(near[0].pixels, 20);
  EXPECT_NEAR(near[0].x_px, 214.98, 0.6);
  EXPECT_NEAR(near[1].x_px, 152.30, 0.6);
  EXPECT_NEAR(near[0].y_px, 112.51, 1.5);  // the shank hides a little of the ball from below
  EXPECT_NEAR(near[1].y_px, 112.51, 1.5);

  tip_m_.z() = -0.8;
  const auto far = seen(*headset);
  EXPECT_NEAR(far[0].x_px, 195.60, 0.6);
  EXPECT_NEAR(far[1].x_px, 148.05, 0.6);
  EXPECT_NEAR(far[0].y_px, 136.26, 1.5);
  EXPECT_GT(near[0].x_px - near[1].x_px, far[0].x_px - far[1].x_px + 10);
  EXPECT_TRUE(left(*headset));
}

TEST_F(Pictures, AReachingAlignmentPutsTheProbeWhereTheHandIs) {
  // The device stands turned by a quarter about the vertical, 0.3 m to the right, 1.2 m up, 0.5 m
  // ahead: S = R_y(90 deg) D + (0.3, 1.2, -0.5). The volume's frame is shifted against the device's
  // by (1, 2, 3). The tip at D (0.1, 0.3, -0.25) is then at V (1.1, 2.3, 2.75) and at
  // S (-0.25 + 0.3, 0.3 + 1.2, -0.1 - 0.5) = (0.05, 1.5, -0.6):
  //   left 0.082/0.6 = 0.136667, 320 (0.136667 + 0.931596)/1.691800 = 202.06; right 149.47
  tip_m_ = {1.1, 2.3, 2.75};
  Shown what = shown();
  what.X_VD.p = {1.0, 2.0, 3.0};
  what.X_SD = math::Pose{
      {0.3, 1.2, -0.5}, math::Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, math::Vec3::UnitY()))};
  auto headset = made(what);
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 5));
  const auto balls = seen(*headset);
  EXPECT_NEAR(balls[0].x_px, 202.06, 0.6);
  EXPECT_NEAR(balls[1].x_px, 149.47, 0.6);
  EXPECT_TRUE(left(*headset));
}

TEST_F(Pictures, WithoutAnAlignmentTheSceneStandsBeforeThePersonAndAPressBringsItBack) {
  tip_m_ = {0.0, 0.0, 0.0};  // the middle of the device's workspace
  Shown what = shown();
  what.X_SD.reset();
  auto headset = made(what);
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 5));
  const auto first = seen(*headset);
  // Straight ahead: the two eyes see it mirrored; 0.22 m below at 0.45 m ahead.
  EXPECT_NEAR(first[0].x_px, 320 * (0.032 / 0.45 + 0.931596) / 1.691800, 0.6);
  EXPECT_NEAR(first[1].x_px, 320 * (-0.032 / 0.45 + 0.760204) / 1.691800, 0.6);
  EXPECT_LT(first[0].y_px, 100);
  control_->head_m[0] = 0.8;  // a step aside: out of sight
  control_->head_yaw_rad = -1.0;
  EXPECT_EQ(seen(*headset)[0].pixels, 0);
  control_->press_at = control_->frames + 2;
  ASSERT_TRUE(step_to(*headset, *control_, control_->frames + 4));
  const auto again = seen(*headset);
  EXPECT_NEAR(again[0].x_px, first[0].x_px, 0.6);
  EXPECT_NEAR(again[1].x_px, first[1].x_px, 0.6);
  EXPECT_TRUE(left(*headset));
}

TEST_F(Pictures, BoneThatIsDrilledAwayIsGoneFromBothEyes) {
  // Between voxel centres a cube of 70 mm, left of the cut, its face 0.43 m ahead: that alone is
  // 320 * 0.07 / (1.6918 * 0.43) = 30.8 pixels wide and 30.9 high, 950 in all.
  volume_.geometry.spacing_m = math::Vec3::Constant(0.01);
  volume_.geometry.origin_m = {-0.1, 1.5, -0.5};
  std::ranges::fill(volume_.counts, volume_.count_of(900.0));
  bool drilled = false;
  Shown what = shown();
  what.carved = [&](const TakeBone& take) {
    if (!drilled) return;
    std::ranges::fill(volume_.counts, volume_.count_of(-1000.0));
    take({.begin = {0, 0, 0}, .end = volume_.geometry.dims}, volume_, {});
    drilled = false;
  };
  auto headset = made(what);
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 5));
  seen(*headset);
  const std::array<std::uint64_t, 2> before{control_->lit_px[0], control_->lit_px[1]};
  drilled = true;
  seen(*headset);
  for (std::size_t eye = 0; eye < 2; ++eye) {
    EXPECT_GT(before[eye], 900u);
    EXPECT_LT(control_->lit_px[eye] + 900u, before[eye]);
  }
  EXPECT_TRUE(left(*headset));
}

// Marrow that has no opacity either way; 4 x 4 x 4 voxels of 10 mm are lost, so half is lost on the
// faces of a cube of 40 mm whose near side, not drawn, is 0.425 m ahead and its far one 0.465 m:
// 320 * 0.04 / (1.6918 * 0.465) = 16.3 pixels wide and high, 260 in all, the edges cut off.
TEST_F(Pictures, WhatABurrTookIsSeenByBothEyesWithoutATraceInTheBone) {
  volume_.geometry.spacing_m = math::Vec3::Constant(0.01);
  volume_.geometry.origin_m = {-0.1, 1.5, -0.5};
  bool drilled = false;
  Shown what = shown();
  what.carved = [&](const TakeBone& take) {
    if (!drilled) return;
    take({}, volume_,
         {.box = {{2, 2, 2}, {6, 6, 6}}, .lost = std::vector<float>(64, 1.0F), .removed_m3 = 0.0});
    drilled = false;
  };
  const auto violet_in = [this](const char* eye) {
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName((folder_ / eye).c_str());
    reader->Update();
    vtkImageData* image = reader->GetOutput();
    int found = 0;
    for (int y = 0; y < image->GetDimensions()[1]; ++y)
      for (int x = 0; x < image->GetDimensions()[0]; ++x) {
        const double green = image->GetScalarComponentAsDouble(x, y, 0, 1);
        found += image->GetScalarComponentAsDouble(x, y, 0, 0) > 1.6 * green &&
                 image->GetScalarComponentAsDouble(x, y, 0, 2) > 1.6 * green;
      }
    return found;
  };
  auto headset = made(what);
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 5));
  seen(*headset);
  for (const char* eye : {"left.png", "right.png"}) EXPECT_EQ(violet_in(eye), 0);
  drilled = true;
  seen(*headset);
  for (const char* eye : {"left.png", "right.png"}) {
    EXPECT_GT(violet_in(eye), 200);
    EXPECT_LT(violet_in(eye), 500);
  }
  EXPECT_TRUE(left(*headset));
}

}  // namespace
}  // namespace headset
}  // namespace tractus
