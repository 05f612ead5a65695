/// NIfTI in: where voxels lie, what they hold, and what is refused. Files are written here from the
/// standard's layout.
#include <gtest/gtest.h>

#include <array>
#include <checkout.hpp>
#include <cstring>

#include "tests/support/nifti_file.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using File = test_support::NiftiFile;
using test_support::kNiftiDims;
using test_support::plain_nifti;
using test_support::Scratch;
using volume::Mat3;
using volume::Vec3;
namespace fs = std::filesystem;

core::Result<volume_io::Imported> read_nifti(const File& file) {
  const Scratch folder;
  test_support::put(folder / "v.nii", file.bytes);
  return volume_io::read_volume(folder / "v.nii");
}

/// Every voxel of the file is where its affine says, turned from RAS mm to LPS m, and holds its
/// value.
void expect_voxels(const volume_io::Imported& in, const Mat3& steps_mm, const Vec3& origin_mm) {
  ASSERT_EQ(in.volume.geometry.dims, kNiftiDims);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) {
        const Vec3 ras_mm = steps_mm * Vec3(i, j, k) + origin_mm;
        const Vec3 lps_m = Vec3(-ras_mm.x(), -ras_mm.y(), ras_mm.z()) * 1e-3;
        EXPECT_LT(
            (in.volume.geometry.position_of({double(i), double(j), double(k)}) - lps_m).norm(),
            1e-7);
        EXPECT_EQ(in.volume.value(i, j, k), 100 * k + 10 * j + i - 50);
      }
}

const Vec3 kSpacing_mm(0.7, 0.8, 1.25), kOrigin_mm(-71.5, 12.25, 300.0);

/// All 48 ways to lay the axes along the patient's, 24 of them left-handed.
std::vector<Mat3> axis_layouts() {
  std::vector<Mat3> out;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      Mat3 m = Mat3::Zero();
      for (int a = 0; a < 3; ++a) m(order[std::size_t(a)], a) = (flips >> a & 1) ? -1.0 : 1.0;
      out.push_back(m);
    }
  } while (std::ranges::next_permutation(order).found);
  return out;
}

TEST(Nifti, PlacesEveryVoxelBySformInAll48AxisLayouts) {
  ASSERT_EQ(axis_layouts().size(), 48u);
  for (const Mat3& layout : axis_layouts()) {
    File file;
    const Mat3 steps = layout * kSpacing_mm.asDiagonal();
    file.sform(steps, kOrigin_mm);
    const auto in = read_nifti(file);
    ASSERT_TRUE(in) << in.error().what;
    expect_voxels(*in, steps, kOrigin_mm);
    EXPECT_TRUE(in->notes.empty());
  }
}

TEST(Nifti, PlacesEveryVoxelByQformInAll48AxisLayouts) {
  for (const Mat3& layout : axis_layouts()) {
    File file;
    const double qfac = layout.determinant() < 0 ? -1.0 : 1.0;
    const Mat3 rotation = layout * Vec3(1, 1, qfac).asDiagonal();
    file.qform(Eigen::Quaterniond(rotation), qfac, kSpacing_mm, kOrigin_mm);
    const auto in = read_nifti(file);
    ASSERT_TRUE(in) << in.error().what;
    expect_voxels(*in, layout * kSpacing_mm.asDiagonal(), kOrigin_mm);
  }
}

TEST(Nifti, PlacesAnObliqueLeftHandedVolume) {
  File file;
  const Mat3 steps = Eigen::AngleAxisd(0.4, Vec3(1, 2, -1).normalized()).toRotationMatrix() *
                     Vec3(0.7, 0.8, -1.25).asDiagonal();
  file.sform(steps, kOrigin_mm);
  const auto in = read_nifti(file);
  ASSERT_TRUE(in) << in.error().what;
  expect_voxels(*in, steps, kOrigin_mm);
}

TEST(Nifti, TheSformWinsWhereTheyDisagreeAndThatIsSaid) {
  for (const double qfac : {1.0, -1.0}) {
    File file;
    file.qform(Eigen::Quaterniond::Identity(), qfac, kSpacing_mm, Vec3::Zero());
    const Mat3 steps = Vec3(-0.7, -0.8, 1.25).asDiagonal();
    file.sform(steps, kOrigin_mm);
    const auto in = read_nifti(file);
    ASSERT_TRUE(in) << in.error().what;
    expect_voxels(*in, steps, kOrigin_mm);
    EXPECT_EQ(in->notes.size(), 1u);
  }
}

TEST(Nifti, ReadsEveryKindOfNumberAndItsScaling) {
  const auto check = [](std::int16_t code, std::int16_t bits, auto sample) {
    using T = decltype(sample);
    File file = plain_nifti();
    file.set<std::int16_t>(70, code);
    file.set<std::int16_t>(72, bits);
    file.set<float>(112, 2.0f);
    file.set<float>(116, -1000.0f);
    file.bytes.resize(352 + 60 * sizeof(T));
    for (std::size_t n = 0; n < 60; ++n) file.set<T>(352 + n * sizeof(T), static_cast<T>(n + 1));
    const auto in = read_nifti(file);
    ASSERT_TRUE(in) << in.error().what;
    for (std::size_t n = 0; n < 60; ++n)
      EXPECT_EQ(in->volume.intercept + in->volume.slope * in->volume.counts[n],
                -1000.0 + 2.0 * double(n + 1))
          << code;
    EXPECT_TRUE(in->notes.empty());
  };
  check(2, 8, std::uint8_t{});
  check(256, 8, std::int8_t{});
  check(4, 16, std::int16_t{});
  check(512, 16, std::uint16_t{});
  check(8, 32, std::int32_t{});
  check(768, 32, std::uint32_t{});
  check(16, 32, float{});
  check(64, 64, double{});
}

TEST(Nifti, ANegativeSlopeTurnsValuesRound) {
  File file = plain_nifti();
  file.set<float>(112, -2.0f);
  file.set<float>(116, 10.0f);
  const auto in = read_nifti(file);
  ASSERT_TRUE(in) << in.error().what;
  EXPECT_GT(in->volume.slope, 0.0);
  EXPECT_EQ(in->volume.value(0, 0, 0), 10.0 + 2.0 * 50);
  EXPECT_EQ(in->volume.value(4, 3, 2), 10.0 - 2.0 * 184);
}

TEST(Nifti, FractionsAreKeptToOneOf65536LevelsAndThatIsSaid) {
  File file = plain_nifti();
  file.set<std::int16_t>(70, 16);
  file.bytes.resize(352 + 240);
  for (std::size_t n = 0; n < 60; ++n)
    file.set<float>(352 + 4 * n, static_cast<float>(n) * 33.3f - 1000.1f);
  const auto in = read_nifti(file);
  ASSERT_TRUE(in) << in.error().what;
  const double level = 59 * 33.3 / 65535;
  for (std::size_t n = 0; n < 60; ++n)
    EXPECT_NEAR(in->volume.intercept + in->volume.slope * in->volume.counts[n],
                double(n) * 33.3 - 1000.1, 0.51 * level + 1e-4);
  ASSERT_EQ(in->notes.size(), 1u);
  EXPECT_NE(in->notes[0].find("65536 levels"), std::string::npos);
}

TEST(Nifti, AnInt32RangeOver65535IsRoundedAndUpTo65535IsKept) {
  File file = plain_nifti();
  file.set<std::int16_t>(70, 8);
  file.bytes.resize(352);
  file.bytes.resize(352 + 240);
  file.set<std::int32_t>(352, 65535);
  auto in = read_nifti(file);
  ASSERT_TRUE(in);
  EXPECT_TRUE(in->notes.empty());
  EXPECT_EQ(in->volume.value(0, 0, 0), 65535.0);
  file.set<std::int32_t>(352, 65536);
  in = read_nifti(file);
  ASSERT_TRUE(in);
  EXPECT_EQ(in->notes.size(), 1u);
}

TEST(Nifti, ReadsBigEndianAndGzipToTheSameVolume) {
  File file = plain_nifti();
  const Scratch folder;
  test_support::put_gzip(folder / "v.nii.gz", file.bytes);
  const auto zipped = volume_io::read_volume(folder / "v.nii.gz");
  ASSERT_TRUE(zipped) << zipped.error().what;
  expect_voxels(*zipped, Mat3::Identity(), Vec3::Zero());
  const auto swap = [&](std::size_t at, std::size_t size, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n)
      std::reverse(file.bytes.begin() + std::ptrdiff_t(at + n * size),
                   file.bytes.begin() + std::ptrdiff_t(at + (n + 1) * size));
  };
  swap(0, 4, 1), swap(40, 2, 8), swap(70, 2, 2), swap(76, 4, 11), swap(252, 2, 2), swap(256, 4, 18),
      swap(352, 2, 60);
  const auto swapped = read_nifti(file);
  ASSERT_TRUE(swapped) << swapped.error().what;
  expect_voxels(*swapped, Mat3::Identity(), Vec3::Zero());
}

TEST(Nifti, ReadsVersion2) {
  // nifti2.h: magic 4, datatype 12, dim 16, pixdim 104, vox_offset 168, slope 176, codes 344, srow
  // 400, units 500.
  const File one = plain_nifti();
  File two;
  two.bytes.assign(544, std::byte{});
  two.set<std::int32_t>(0, 540);
  std::memcpy(two.bytes.data() + 4, "n+2\0\r\n\032\n", 8);
  two.set<std::int16_t>(12, 4);
  two.set<std::int64_t>(16, 3);
  for (std::size_t a = 0; a < 3; ++a) {
    two.set<std::int64_t>(24 + 8 * a, kNiftiDims[a]);
    two.set<double>(112 + 8 * a, 1.0);
    two.set<double>(400 + 40 * a, 1.0);
  }
  two.set<std::int64_t>(168, 544);
  two.set<std::int32_t>(348, 1);
  two.set<std::int32_t>(500, 2);
  two.bytes.insert(two.bytes.end(), one.bytes.begin() + 352, one.bytes.end());
  const auto in = read_nifti(two);
  ASSERT_TRUE(in) << in.error().what;
  expect_voxels(*in, Mat3::Identity(), Vec3::Zero());
}

/// The real CTs, against header values read independently with Python's struct module (dim at byte
/// 40, srow at 280).
struct RealCt {
  const char* file;
  std::array<int, 3> dims;
  std::array<double, 12> srow_mm;
  double low, high;  ///< values, from the data set's description
};

TEST(Nifti, ImportsTheThreeRealCtsWhereTheirHeadersSay) {
  const std::array<RealCt, 3> cts = {
      RealCt{"tptbox_L3/sub-ct_label-22_ct.nii.gz",
             {73, 47, 73},
             {0, 0, 1.5, -78, -1.5, 0, 0, -135, 0, -1.5, 0, -34.199981689453125},
             -1030,
             1961},
      RealCt{"totalseg_lumbar_pelvis/example_ct.nii.gz",
             {122, 101, 112},
             {3, 0, 0, -177.95632934570312, 0, 3, 0, 11.319000244140625, 0, 0, 3, 94.3017578125},
             -1207,
             3382},
      RealCt{"totalseg_thorax_cta/ct_cropped.nii.gz",
             {120, 126, 164},
             {-1.5, 0, 0, 71.658203125, 0, -1.5, 0, 255.658203125, 0, 0, 1.5, 540.2000122070312},
             -1078,
             3343}};
  for (const RealCt& ct : cts) {
    const auto in = volume_io::read_volume(fs::path(checkout::kSource) / "tests/data/ct" / ct.file);
    ASSERT_TRUE(in) << in.error().what;
    const auto& g = in->volume.geometry;
    ASSERT_EQ(g.dims, ct.dims);
    const Vec3 index(7, 11, 13);
    for (int r = 0; r < 3; ++r) {
      const auto& s = ct.srow_mm;
      const std::size_t at = 4 * std::size_t(r);
      const double ras_mm = s[at] * 7 + s[at + 1] * 11 + s[at + 2] * 13 + s[at + 3];
      EXPECT_NEAR(g.position_of(index)[r], (r < 2 ? -1 : 1) * ras_mm * 1e-3, 1e-9);
    }
    const auto [low, high] = std::ranges::minmax_element(in->volume.counts);
    EXPECT_EQ(in->volume.intercept + in->volume.slope * *low, ct.low);
    EXPECT_EQ(in->volume.intercept + in->volume.slope * *high, ct.high);
    EXPECT_EQ(in->volume.slope, 1.0);
  }
}

}  // namespace
}  // namespace tractus
