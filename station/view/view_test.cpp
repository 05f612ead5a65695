#include "station/view/view.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCell.h>
#include <vtkImageData.h>
#include <vtkMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkPNGReader.h>

#include <cmath>
#include <functional>

#include "core/bytes.hpp"
#include "station/view/scene_parts.hpp"

namespace tractus {
namespace view {
namespace {

using math::Vec3;
constexpr int kWidth_px = 320, kHeight_px = 240;

/// A block 40 mm wide with a tract of 2 mm radius along z; 1 mm voxels.
volume::Volume block(double value_HU) {
  volume::Volume v;
  v.geometry.dims = {40, 40, 40};
  v.geometry.spacing_m = Vec3::Constant(1e-3);
  v.geometry.origin_m = Vec3::Constant(-0.02);
  v.intercept = -1024;
  v.counts.resize(v.geometry.voxel_count());
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i)
        v.counts[v.offset(i, j, k)] =
            v.count_of(std::hypot(i - 20, j - 20) < 2 && k < 30 ? -100 : value_HU);
  return v;
}
const volume::Box kAll{{0, 0, 0}, {40, 40, 40}}, kNowhere;

/// Lost by the distance from something: so much at `radius_m`, a quarter more each millimetre
/// inwards.
drilling::ErodedShares worn(const volume::Geometry& geometry, double radius_m, double at_radius,
                            const std::function<double(const Vec3&)>& distance_m) {
  drilling::ErodedShares out{.box = kAll, .lost = {}, .removed_m3 = 3e-8};
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i) {
        const double inside_m = radius_m - distance_m(geometry.position_of(Vec3(i, j, k)));
        out.lost.push_back(float(std::clamp(at_radius + inside_m / 4e-3, 0.0, 1.0)));
      }
  return out;
}

/// Where a point is seen, from the lower left corner: the eye at (98, 17, -46) mm looks at the
/// focus (0, 0, -8) mm, y up, 32° high.
math::Vec2 pixel_of(const Vec3& p_m) {
  const Vec3 eye(0.098, 0.017, -0.046), focus(0.0, 0.0, -0.008);
  const Vec3 ahead = (focus - eye).normalized(), right = ahead.cross(Vec3::UnitY()).normalized();
  const Vec3 d = p_m - eye;
  const double scale = 0.5 * kHeight_px / std::tan(16.0 * M_PI / 180.0) / d.dot(ahead);
  return {0.5 * kWidth_px + scale * d.dot(right),
          0.5 * kHeight_px + scale * d.dot(right.cross(ahead))};
}

/// A picture read back.
class Pixels {
 public:
  explicit Pixels(const std::filesystem::path& png) {
    reader_->SetFileName(png.c_str());
    reader_->Update();
  }
  const int* size() const { return reader_->GetOutput()->GetDimensions(); }
  double at(int x, int y, int colour) const {
    return reader_->GetOutput()->GetScalarComponentAsDouble(x, y, 0, colour);
  }
  double brightness(int x, int y) const { return (at(x, y, 0) + at(x, y, 1) + at(x, y, 2)) / 3; }
  bool purple(int x, int y) const {
    return at(x, y, 0) > 1.6 * at(x, y, 1) && at(x, y, 2) > 1.4 * at(x, y, 1);
  }
  bool purple(const Vec3& p_m) const {
    const math::Vec2 p = pixel_of(p_m);
    return purple(int(p.x()), int(p.y()));
  }
  bool red(int x, int y) const {
    return at(x, y, 0) > 25 && at(x, y, 0) > 1.6 * at(x, y, 1) && at(x, y, 2) < 1.2 * at(x, y, 1);
  }
  /// Above the words.
  template <class Is>
  int count(Is is) const {
    int found = 0;
    for (int y = 112; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) found += is(x, y);
    return found;
  }

 private:
  vtkNew<vtkPNGReader> reader_;
};

/// One scene for all of them, with a burr of 4 mm whose tip is 3 mm ahead of its ball's centre.
class ViewTest : public testing::Test {
 protected:
  static constexpr double kBall_m = 0.004, kNose_m = 0.003, kLength_m = 0.13;
  static volume::Tract tract() {
    volume::Tract out;
    out.entry_m = {0, 0, -0.02};
    out.length_m = 0.03;
    out.radius_m = 0.002;
    return out;
  }
  static void SetUpTestSuite() {
    const auto bone = block(900);
    const auto transfer = volume::TransferFunction::bone();
    auto made = View::make({.volume = bone,
                            .transfer = transfer,
                            .tract = tract(),
                            .probe = {},
                            .burr = drilling::Burr{.radius_m = kBall_m, .nose_m = kNose_m}},
                           Mode::offscreen, kWidth_px, kHeight_px);
    ASSERT_TRUE(made) << made.error().what;
    view_ = std::move(*made);
  }
  static void TearDownTestSuite() { view_.reset(); }
  void SetUp() override { ASSERT_TRUE(view_); }
  void TearDown() override {
    std::filesystem::remove(picture_);
    view_->carve_away(kAll, block(900), {});
  }
  /// The straight tool along z with the middle of its ball there.
  Pixels seen(const Vec3& ball_m, std::span<const Vec3> path_m = {}) {
    ProbeState state;
    state.X_VH.p = ball_m - Vec3(0, 0, kLength_m - kNose_m);
    view_->draw(state, path_m);
    EXPECT_TRUE(view_->save_png(picture_));
    return Pixels(picture_);
  }
  const Vec3 away_m_{0, 0, -0.5};
  static inline std::unique_ptr<View> view_;
  std::filesystem::path picture_ =
      std::filesystem::temp_directory_path() / ("tractus_view_" + core::new_id() + ".png");
};

TEST_F(ViewTest, OffscreenShowsBoneInTheMiddleAndBackgroundInTheCorner) {
  const Pixels image = seen(away_m_);
  EXPECT_EQ(image.size()[0], kWidth_px);
  EXPECT_LT(image.brightness(3, 236), 40);    // background 0.1 · 255
  EXPECT_GT(image.brightness(160, 150), 80);  // bone, lit
}

// The half of the block that is carved away shows the background where bone was.
TEST_F(ViewTest, BoneThatWasCarvedAwayIsGoneFromTheNextPicture) {
  const auto bright_pixels = [&] {
    const Pixels image = seen(away_m_);
    return image.count([&](int x, int y) { return image.brightness(x, y) > 80; });
  };
  const int whole = bright_pixels();
  auto bone = block(900);
  std::fill_n(bone.counts.begin(), 40 * 40 * 20, std::uint16_t(0));
  view_->carve_away({{0, 0, 0}, {40, 40, 20}}, bone, {});
  const int left = bright_pixels();
  view_->carve_away({{0, 0, 20}, {40, 40, 40}}, block(900), {});  // its own counts: nothing new
  EXPECT_EQ(bright_pixels(), left);
  EXPECT_GT(whole, 2000);
  EXPECT_LT(left, 3 * whole / 4);
  EXPECT_GT(left, whole / 8);
}

// A ball of 4 mm a fifth of the way from the focus to the eye, which is 106.5 mm from there:
// at 85.2 mm it is seen in the middle, 120 px / tan 16° · 4 / √(85.2² − 4²) = 19.7 px in radius.
// The shank comes from the right.
TEST_F(ViewTest, TheBurrsBallIsWhereItsNoseSaysAndAsLargeAsItIs) {
  const Pixels image = seen(Vec3(0, 0, -0.008) + 0.2 * Vec3(0.098, 0.017, -0.038));
  int left = kWidth_px, below = kHeight_px, above = 0, found = 0, outside = 0;
  for (int y = 0; y < kHeight_px; ++y)
    for (int x = 0; x < kWidth_px; ++x) {
      if (!image.red(x, y)) continue;
      outside += std::hypot(x + 0.5 - 160, y + 0.5 - 120) > 20.7;
      left = std::min(left, x), below = std::min(below, y), above = std::max(above, y + 1);
      ++found;
    }
  EXPECT_EQ(outside, 0);
  EXPECT_NEAR(left, 160 - 19.7, 1.5);
  EXPECT_NEAR(below, 120 - 19.7, 1.5);
  EXPECT_NEAR(above, 120 + 19.7, 1.5);
  EXPECT_GT(found, 0.8 * M_PI * 19.7 * 19.7);
}

// A channel of 3 mm radius along y = 6 mm through marrow that has no opacity: the counts say
// nothing of it.
TEST_F(ViewTest, AChannelThroughMarrowIsSeenWhereItRunsAndNotBefore) {
  const auto marrow = block(100);
  const auto channel = [&](double at_radius) {
    return worn(marrow.geometry, 0.003, at_radius, [](const Vec3& p) {
      const double across = std::hypot(p.x(), p.y() - 0.006);
      return std::max(across, std::abs(p.z()) - 0.007);  // 20 mm long
    });
  };
  const auto purple = [](const Pixels& image) {
    return image.count([&](int x, int y) { return image.purple(x, y); });
  };
  view_->carve_away(kAll, marrow, channel(-0.3));  // 0.45 in its middle
  EXPECT_EQ(purple(seen(away_m_)), 0);
  view_->carve_away(kNowhere, marrow, channel(0.5));
  const Pixels image = seen(away_m_);
  for (const double z_m : {-0.006, 0.0, 0.006}) {
    for (const double y_m : {-0.0022, 0.0, 0.0022})
      EXPECT_TRUE(image.purple(Vec3(0, 0.006 + y_m, z_m))) << y_m << " " << z_m;
    for (const double y_m : {-0.004, 0.004})
      EXPECT_FALSE(image.purple(Vec3(0, 0.006 + y_m, z_m))) << y_m << " " << z_m;
  }
  EXPECT_FALSE(image.purple(Vec3(0, 0.006, 0.015)));
  EXPECT_FALSE(image.purple(Vec3(0, 0.006, -0.015)));
  // One looks into it: the ball in its middle is not hidden by the wall before it.
  const Pixels with_ball = seen({0, 0.006, 0.0});
  const math::Vec2 middle = pixel_of({0, 0.006, 0.0});
  EXPECT_TRUE(with_ball.red(int(middle.x()), int(middle.y())));
  view_->carve_away(kNowhere, marrow, {});
  EXPECT_EQ(purple(seen(away_m_)), 0);
}

TEST_F(ViewTest, AWindowWithoutADisplayIsRefusedInWords) {
  const char* display = ::getenv("DISPLAY");
  const std::string kept = display ? display : "";
  ::unsetenv("DISPLAY");
  const auto bone = block(900);
  const auto transfer = volume::TransferFunction::bone();
  const auto made = View::make({.volume = bone, .transfer = transfer, .tract = {}, .probe = {}},
                               Mode::window, 64, 64);
  if (display) ::setenv("DISPLAY", kept.c_str(), 1);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, core::Errc::unavailable);
}

// A ball of 6 mm: 4/3 π 6³ = 905 mm³, its faces turned outwards (the divergence theorem), in a
// volume of either hand.
TEST(PilotHoleSurface, IsClosedLiesWhereTheVoxelsDoAndFacesOutwards) {
  const Vec3 middle_m(0.003, -0.002, 0.004);
  const auto transfer = volume::TransferFunction::bone();
  for (const double hand : {1.0, -1.0}) {
    auto bone = block(900);
    bone.geometry.directions.col(0) *= hand;
    bone.geometry.origin_m.x() *= hand;
    const auto ball =
        worn(bone.geometry, 0.006, 0.5, [&](const Vec3& p) { return (p - middle_m).norm(); });
    vtkNew<vtkRenderer> renderer;
    PilotHoleSurface channel;
    channel.add(*renderer,
                {.volume = bone, .transfer = transfer, .tract = {}, .probe = {}, .worn = &ball});
    vtkActor* actor = renderer->GetActors()->GetLastActor();
    ASSERT_TRUE(actor && actor->GetVisibility());
    actor->GetMapper()->Update();
    auto* surface = vtkPolyData::SafeDownCast(actor->GetMapper()->GetInput());
    ASSERT_TRUE(surface);
    double volume_m3 = 0.0;
    Vec3 moment_m4 = Vec3::Zero();
    for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell) {
      std::array<Vec3, 3> p;
      for (int i = 0; i < 3; ++i) {
        double at[4] = {0, 0, 0, 1};
        surface->GetPoint(surface->GetCell(cell)->GetPointId(i), at);
        at[3] = 1.0;
        actor->GetMatrix()->MultiplyPoint(at, at);
        p[std::size_t(i)] = {at[0], at[1], at[2]};
      }
      const double part_m3 = p[0].dot(p[1].cross(p[2])) / 6.0;
      volume_m3 += part_m3;
      moment_m4 += part_m3 * (p[0] + p[1] + p[2]) / 4.0;
    }
    EXPECT_NEAR(volume_m3, 905e-9, 20e-9) << hand;
    EXPECT_LT((moment_m4 / volume_m3 - middle_m).norm(), 5e-5) << hand;
  }
}

}  // namespace
}  // namespace view
}  // namespace tractus
