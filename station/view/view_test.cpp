#include "station/view/view.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cmath>

#include "core/bytes.hpp"

namespace view {
namespace {

/// A block of bone 40 mm wide with a tract of 2 mm radius along z; 1 mm voxels.
volume::Volume block() {
  volume::Volume v;
  v.geometry.dims = {40, 40, 40};
  v.geometry.spacing_m = math::Vec3::Constant(1e-3);
  v.geometry.origin_m = math::Vec3::Constant(-0.02);
  v.intercept = -1024;
  v.counts.resize(v.geometry.voxel_count());
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i)
        v.counts[v.offset(i, j, k)] =
            v.count_of(std::hypot(i - 20, j - 20) < 2 && k < 30 ? -100 : 900);
  return v;
}

class ViewTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(picture_); }
  std::filesystem::path picture_ =
      std::filesystem::temp_directory_path() / ("tractus_view_" + core::new_id() + ".png");
};

TEST_F(ViewTest, OffscreenShowsBoneInTheMiddleAndBackgroundInTheCorner) {
  const auto bone = block();
  const auto transfer = volume::TransferFunction::bone();
  volume::Tract tract;
  tract.entry_m = {0, 0, -0.02};
  tract.length_m = 0.03;
  tract.radius_m = 0.002;
  auto made = View::make({bone, transfer, tract, {}}, Mode::offscreen, 320, 240);
  ASSERT_TRUE(made) << made.error().what;
  ProbeState state;
  state.X_VH.p = {0, 0, -0.13};
  (*made)->draw(state, {});
  ASSERT_TRUE((*made)->save_png(picture_));

  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(picture_.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  EXPECT_EQ(image->GetDimensions()[0], 320);
  const auto brightness = [&](int x, int y) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += image->GetScalarComponentAsDouble(x, y, 0, c);
    return sum / 3;
  };
  EXPECT_LT(brightness(3, 236), 40);    // background 0.1 · 255
  EXPECT_GT(brightness(160, 150), 80);  // bone, lit
}

// The half of the block that is carved away shows the background where bone was.
TEST_F(ViewTest, BoneThatWasCarvedAwayIsGoneFromTheNextPicture) {
  auto bone = block();
  const auto transfer = volume::TransferFunction::bone();
  volume::Tract tract;
  tract.entry_m = {0, 0, -0.02};
  tract.length_m = 0.03;
  tract.radius_m = 0.002;
  auto made = View::make({bone, transfer, tract, {}}, Mode::offscreen, 320, 240);
  ASSERT_TRUE(made) << made.error().what;
  ProbeState away;
  away.X_VH.p = {0, 0, -0.5};
  const auto bright_pixels = [&] {
    (*made)->draw(away, {});
    EXPECT_TRUE((*made)->save_png(picture_));
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(picture_.c_str());
    reader->Update();
    int bright = 0;
    for (int y = 40; y < 240; ++y)
      for (int x = 0; x < 320; ++x)
        bright += reader->GetOutput()->GetScalarComponentAsDouble(x, y, 0, 0) > 80;
    return bright;
  };
  const int whole = bright_pixels();
  const volume::Box half{{0, 0, 0}, {40, 40, 20}};
  std::fill_n(bone.counts.begin(), 40 * 40 * 20, std::uint16_t(0));
  (*made)->carve_away(half, bone);
  const int left = bright_pixels();
  (*made)->carve_away({{0, 0, 20}, {40, 40, 40}},
                      block());  // the other half's own counts: nothing new
  EXPECT_EQ(bright_pixels(), left);
  EXPECT_GT(whole, 2000);
  EXPECT_LT(left, 3 * whole / 4);
  EXPECT_GT(left, whole / 8);
}

TEST_F(ViewTest, AWindowWithoutADisplayIsRefusedInWords) {
  const char* display = ::getenv("DISPLAY");
  const std::string kept = display ? display : "";
  ::unsetenv("DISPLAY");
  const auto bone = block();
  const auto transfer = volume::TransferFunction::bone();
  const auto made = View::make({bone, transfer, {}, {}}, Mode::window, 64, 64);
  if (display) ::setenv("DISPLAY", kept.c_str(), 1);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, core::Errc::unavailable);
}

}  // namespace
}  // namespace view
