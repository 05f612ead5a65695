/// NIfTI files that lie, are cut, or are none.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "tests/support/nifti_file.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using File = test_support::NiftiFile;
using test_support::plain_nifti;
using test_support::Scratch;
namespace fs = std::filesystem;

core::Result<volume_io::Imported> read(const File& file) {
  const Scratch folder;
  test_support::put(folder / "v.nii", file.bytes);
  return volume_io::read_volume(folder / "v.nii");
}

struct NiftiLie {
  const char* name;
  std::function<void(File&)> tell;
  const char* word;  ///< in the message
};

class NiftiLies : public testing::TestWithParam<NiftiLie> {};

TEST_P(NiftiLies, IsRefusedInOneLineThatNamesTheFileAndThePlace) {
  File file = plain_nifti();
  GetParam().tell(file);
  const auto in = read(file);
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("v.nii: "), std::string::npos) << in.error().what;
  EXPECT_NE(in.error().what.find(GetParam().word), std::string::npos) << in.error().what;
  EXPECT_EQ(in.error().what.find('\n'), std::string::npos);
}

const float kNaN = std::numeric_limits<float>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(
    All, NiftiLies,
    testing::Values(
        NiftiLie{"NegativeDim", [](File& f) { f.set<std::int16_t>(44, -4); }, "dim: axis 2"},
        NiftiLie{"ZeroDim", [](File& f) { f.set<std::int16_t>(46, 0); }, "dim: axis 3"},
        NiftiLie{"HugeDims",
                 [](File& f) {
                   for (std::size_t a = 42; a < 48; a += 2) f.set<std::int16_t>(a, 32767);
                 },
                 "dim: axis 1"},
        NiftiLie{"TooManyVoxels",
                 [](File& f) {
                   for (std::size_t a = 42; a < 48; a += 2) f.set<std::int16_t>(a, 4096);
                 },
                 "4096 × 4096"},
        NiftiLie{"MoreThanTheFileHas", [](File& f) { f.set<std::int16_t>(42, 6); },
                 "its header declares 496"},
        NiftiLie{"LessThanTheFileHas", [](File& f) { f.set<std::int16_t>(42, 4); },
                 "its header declares 448"},
        NiftiLie{"Truncated", [](File& f) { f.bytes.resize(400); }, "has 400 bytes"},
        NiftiLie{"CutInTheHeader", [](File& f) { f.bytes.resize(200); }, "no NIfTI"},
        NiftiLie{"Series",
                 [](File& f) {
                   f.set<std::int16_t>(40, 4);
                   f.set<std::int16_t>(48, 7);
                 },
                 "dim[4] is 7"},
        NiftiLie{"Colours", [](File& f) { f.set<std::int16_t>(70, 128); }, "datatype 128"},
        NiftiLie{"NanSpacing", [](File& f) { f.set<float>(280, kNaN); }, "sform"},
        NiftiLie{"ZeroSpacing", [](File& f) { f.set<float>(280, 0.0f); }, "sform"},
        NiftiLie{"InfiniteOrigin",
                 [](File& f) { f.set<float>(292, std::numeric_limits<float>::infinity()); },
                 "sform"},
        NiftiLie{"FarOrigin", [](File& f) { f.set<float>(292, 1e30f); }, "origin"},
        NiftiLie{"Sheared", [](File& f) { f.set<float>(284, 0.3f); }, "right angles"},
        NiftiLie{"NoOrientation", [](File& f) { f.set<std::int16_t>(254, 0); },
                 "sform_code and qform_code are 0"},
        NiftiLie{"NanQuaternion",
                 [](File& f) {
                   f.set<std::int16_t>(254, 0);
                   f.set<std::int16_t>(252, 1);
                   f.set<float>(256, kNaN);
                 },
                 "qform"},
        NiftiLie{"OffsetInTheHeader", [](File& f) { f.set<float>(108, 10.0f); }, "vox_offset 10"},
        NiftiLie{"OffsetNan", [](File& f) { f.set<float>(108, kNaN); }, "vox_offset"},
        NiftiLie{"OffsetFar", [](File& f) { f.set<float>(108, 1e15f); }, "vox_offset"},
        NiftiLie{"SlopeNan", [](File& f) { f.set<float>(112, kNaN); }, "scl_slope"},
        NiftiLie{"NanVoxel",
                 [](File& f) {
                   f.set<std::int16_t>(70, 16);
                   f.bytes.resize(352);
                   f.bytes.resize(592);
                   f.set<float>(352 + 28, kNaN);
                 },
                 "voxel 7 of 60"},
        NiftiLie{"Pair", [](File& f) { f.bytes[345] = std::byte{'i'}; }, ".hdr/.img"}),
    [](const auto& named) { return std::string(named.param.name); });

TEST(Nifti, ATextFileRenamedIsNoNifti) {
  const Scratch folder;
  test_support::put(folder / "v.nii", core::bytes_of("Dear diary, today the drill slipped.\n"));
  const auto in = volume_io::read_volume(folder / "v.nii");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("v.nii: starts with \"Dear diary, toda\""), std::string::npos)
      << in.error().what;
}

TEST(Nifti, GzipThatInflatesToMoreOrLessThanDeclaredIsRefused) {
  const Scratch folder;
  const File file = plain_nifti();
  test_support::put_gzip_of_zeros(folder / "more.nii.gz", file.bytes, 64u << 20);
  auto in = volume_io::read_volume(folder / "more.nii.gz");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("inflates to more than the 472 bytes"), std::string::npos)
      << in.error().what;
  File huge = file;  // 1200³ int16 are 3.5 GB; the file inflates to 64 MiB
  for (std::size_t a = 42; a < 48; a += 2) huge.set<std::int16_t>(a, 1200);
  test_support::put_gzip_of_zeros(folder / "less.nii.gz", huge.bytes, 64u << 20);
  in = volume_io::read_volume(folder / "less.nii.gz");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("which no CT reaches"), std::string::npos) << in.error().what;
  test_support::put_gzip(folder / "cut.nii.gz", file.bytes);
  fs::resize_file(folder / "cut.nii.gz", fs::file_size(folder / "cut.nii.gz") - 30);
  in = volume_io::read_volume(folder / "cut.nii.gz");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("truncated or damaged"), std::string::npos) << in.error().what;
}

TEST(Nifti, RandomDamageIsReadOrRefusedAndNothingElse) {
  std::mt19937 random(3);
  const File whole = plain_nifti();
  for (int n = 0; n < 3000; ++n) {
    File file = whole;
    for (int d = 0; d < 4; ++d) file.bytes[random() % 352] = static_cast<std::byte>(random());
    if (n % 3 == 0) file.bytes.resize(random() % file.bytes.size());
    const auto in = read(file);
    if (in)
      EXPECT_EQ(in->volume.counts.size(), in->volume.geometry.voxel_count());
    else
      EXPECT_EQ(in.error().what.find('\n'), std::string::npos) << in.error().what;
  }
}

}  // namespace
}  // namespace tractus
