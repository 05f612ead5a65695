/// Pictures: right way round, to scale, and without a display. Pixels are read back through VTK's
/// PNG reader.
#include "volume/io/picture.hpp"

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include "tests/support/scratch.hpp"

namespace tractus {
namespace {
using test_support::Scratch;
using volume::Vec3;
using volume::Volume;
using volume_io::Overlay;

/// Simulated: 100 × 80 × 60 mm of water, 1 mm voxels, axes along L, P, S, centred on zero, with a
/// bone cube of 10 mm at
/// (+20 left, +10 posterior, +15 superior) mm.
Volume picture_phantom() {
  Volume v;
  v.geometry.dims = {101, 81, 61};
  v.geometry.spacing_m = Vec3::Constant(1e-3);
  v.geometry.origin_m = {-0.05, -0.04, -0.03};
  v.intercept = -1000.0;
  v.counts.assign(v.geometry.voxel_count(), 1000);
  for (int k = 40; k <= 50; ++k)
    for (int j = 45; j <= 55; ++j)
      for (int i = 65; i <= 75; ++i) v.counts[v.offset(i, j, k)] = 3000;
  return v;
}

struct Picture {
  vtkNew<vtkPNGReader> reader;
  explicit Picture(const std::filesystem::path& path) {
    reader->SetFileName(path.c_str());
    reader->Update();
  }
  int width() { return reader->GetOutput()->GetDimensions()[0]; }
  int height() { return reader->GetOutput()->GetDimensions()[1]; }
  /// Red, green, blue at a place counted from the top left.
  std::array<int, 3> at(int x, int y) {
    const auto* p =
        static_cast<unsigned char*>(reader->GetOutput()->GetScalarPointer(x, height() - 1 - y, 0));
    return {p[0], p[1], p[2]};
  }
};

/// Panels of 510 px that show 102 mm: 5 px/mm. Panel n begins at x = 8 + n (510 + 8), y = 8.
constexpr volume_io::PictureOptions kOptions{.panel_px = 510, .extent_m = 0.102};
constexpr std::array kWhite{255, 255, 255};

std::array<int, 2> pixel(int panel, double right_mm, double down_mm) {
  return {8 + panel * 518 + static_cast<int>(255 + 5 * right_mm),
          8 + static_cast<int>(255 + 5 * down_mm)};
}

TEST(Picture, ShowsThePatientAsRadiologistsDoAndToScale) {
  const Scratch folder;
  const Vec3 at(0.020, 0.010, 0.015);
  ASSERT_TRUE(volume_io::write_slices_png(folder / "p.png", picture_phantom(), at, kOptions));
  Picture picture(folder / "p.png");
  ASSERT_EQ(picture.width(), 3 * 510 + 4 * 8);
  ASSERT_EQ(picture.height(), 510 + 8 + 28);
  // The square is centred on the point: the cube (± 5 mm) fills the middle and ends 5.5 mm from it.
  for (int panel = 0; panel < 3; ++panel) {
    for (const auto& [x, y] : {pixel(panel, 2, 2), pixel(panel, -4, -4), pixel(panel, 4, 4)})
      EXPECT_EQ(picture.at(x, y), kWhite);
    for (const auto& [x, y] :
         {pixel(panel, 7, 3), pixel(panel, -7, 3), pixel(panel, 3, 7), pixel(panel, 3, -7)})
      EXPECT_LT(picture.at(x, y)[0], 100);
  }
}

TEST(Picture, LeftIsRightAndSuperiorIsUp) {
  const Scratch folder;
  // Slices through the cube's middle, the square centred on the volume: the cube shows beside the
  // middle.
  ASSERT_TRUE(volume_io::write_slices_png(folder / "p.png", picture_phantom(),
                                          {0.020, 0.010, 0.015}, {.panel_px = 510}));
  Picture picture(folder / "p.png");
  const double px_per_mm = 510 / (101 * 1.02);
  const auto look = [&](int panel, double right_mm, double down_mm) {
    return picture.at(8 + panel * 518 + static_cast<int>(255 + px_per_mm * right_mm),
                      8 + static_cast<int>(255 + px_per_mm * down_mm));
  };
  EXPECT_EQ(look(0, 22, 12),
            kWhite);  // axial: the patient's left is on the right, posterior is down
  EXPECT_EQ(look(1, 22, -17), kWhite);  // coronal: superior is up
  EXPECT_EQ(look(2, 12, -17), kWhite);  // sagittal: posterior is on the right
  EXPECT_NE(look(0, -22, 12), kWhite);
  EXPECT_NE(look(1, 22, 17), kWhite);
  EXPECT_NE(look(2, -12, -17), kWhite);
}

TEST(Picture, DirectionsOfTheVolumeDoNotChangeThePicture) {
  const Scratch folder;
  const Volume v = picture_phantom();
  Volume turned = v;  // the same patient stored with axes P, S, R
  turned.geometry.dims = {81, 61, 101};
  turned.geometry.directions << 0, 0, -1, 1, 0, 0, 0, 1, 0;
  turned.geometry.origin_m = {0.05, -0.04, -0.03};
  for (int k = 0; k < 101; ++k)
    for (int j = 0; j < 61; ++j)
      for (int i = 0; i < 81; ++i)
        turned.counts[turned.offset(i, j, k)] = v.counts[v.offset(100 - k, i, j)];
  const Vec3 at(0.018, 0.012, 0.013);
  ASSERT_TRUE(volume_io::write_slices_png(folder / "a.png", v, at, kOptions));
  ASSERT_TRUE(volume_io::write_slices_png(folder / "b.png", turned, at, kOptions));
  Picture a(folder / "a.png"), b(folder / "b.png");
  int different = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) different += std::abs(a.at(x, y)[0] - b.at(x, y)[0]) > 2;
  EXPECT_EQ(different, 0);
}

TEST(Picture, OverlaysLieWhereThePatientsPointsAre) {
  const Scratch folder;
  Overlay line{.kind = Overlay::Kind::line,
               .from_m = {-0.03, -0.02, -0.01},
               .to_m = {-0.03, 0.03, -0.01},
               .colour = {255, 0, 0}};
  Overlay ring{.kind = Overlay::Kind::circle,
               .from_m = {0, 0, 0},
               .to_m = {0, 0, 1},
               .radius_m = 0.02,
               .colour = {0, 255, 0}};
  ASSERT_TRUE(volume_io::write_slices_png(folder / "p.png", picture_phantom(), Vec3::Zero(),
                                          kOptions, std::array{line, ring}));
  Picture picture(folder / "p.png");
  const auto look = [&](int panel, double right_mm, double down_mm) {
    const auto [x, y] = pixel(panel, right_mm, down_mm);
    return picture.at(x, y);
  };
  EXPECT_EQ(look(0, -30, 20), (std::array{255, 0, 0}));  // axial: along the picture's height
  EXPECT_EQ(look(2, 20, 10),
            (std::array{255, 0, 0}));   // sagittal: along its width, below the middle
  EXPECT_GT(look(1, -30, 10)[0], 200);  // coronal: on end, a dot of 2 px
  EXPECT_LT(look(1, -30, 10)[1], 40);
  const double diagonal = 20 / std::sqrt(2.0);
  EXPECT_GT(look(0, diagonal, diagonal)[1], 200);  // axial: a ring
  EXPECT_GT(look(1, 10, 0)[1], 200);               // coronal: seen on edge
}

TEST(Picture, APointOutsideIsRefusedAndNothingIsWritten) {
  const Scratch folder;
  const auto out = volume_io::write_slices_png(folder / "p.png", picture_phantom(), {0.2, 0, 0});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, core::Errc::out_of_range);
  EXPECT_NE(out.error().what.find("200.0, 0.0, 0.0 mm lies outside"), std::string::npos)
      << out.error().what;
  EXPECT_FALSE(volume_io::write_slices_png(folder / "p.png", picture_phantom(), Vec3::Zero(),
                                           {.window = {0.0, 0.0}}));
  EXPECT_FALSE(volume_io::write_slices_png(folder / "p.png", picture_phantom(),
                                           Vec3::Constant(std::nan(""))));
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace tractus
