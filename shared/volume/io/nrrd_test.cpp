/// NRRD in: spaces, encodings, detached data, and what is refused. Files are written here from the
/// format's description.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <random>

#include "tests/support/scratch.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using test_support::Scratch;
using volume::Vec3;
namespace fs = std::filesystem;

/// 5 × 4 × 3 little-endian int16, value = 100 k + 10 j + i − 50.
core::Bytes voxels(bool big = false) {
  core::Bytes out;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) {
        const int value = 100 * k + 10 * j + i - 50;
        const auto low = static_cast<std::byte>(value & 0xff),
                   high = static_cast<std::byte>(value >> 8 & 0xff);
        out.insert(out.end(), {big ? high : low, big ? low : high});
      }
  return out;
}

struct Header {
  std::string type = "short", dimension = "3", space = "left-posterior-superior", sizes = "5 4 3",
              directions = "(0.7,0,0) (0,0.8,0) (0,0,1.25)", origin = "(-71.5,12.25,300)",
              endian = "little", encoding = "raw", more = "";
  std::string text() const {
    return fmt::format(
        "NRRD0005\n# by hand\ntype: {}\ndimension: {}\nspace: {}\nsizes: {}\nspace directions: {}\n"
        "kinds: domain domain domain\nendian: {}\nencoding: {}\nspace origin: {}\n{}",
        type, dimension, space, sizes, directions, endian, encoding, origin, more);
  }
};

core::Bytes joined(const std::string& text, const core::Bytes& data) {
  const auto start = core::bytes_of(text);
  core::Bytes out(start.begin(), start.end());
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

core::Result<volume_io::Imported> read_nrrd(const Header& header,
                                            const core::Bytes& data = voxels()) {
  const Scratch folder;
  test_support::put(folder / "v.nrrd", joined(header.text() + "\n", data));
  return volume_io::read_volume(folder / "v.nrrd");
}

void expect_voxels(const core::Result<volume_io::Imported>& in, const Vec3& lps = {1, 1, 1}) {
  ASSERT_TRUE(in) << in.error().what;
  ASSERT_EQ(in->volume.geometry.dims, (std::array{5, 4, 3}));
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) {
        const Vec3 at_m =
            lps.cwiseProduct(Vec3(-71.5 + 0.7 * i, 12.25 + 0.8 * j, 300 + 1.25 * k)) * 1e-3;
        EXPECT_LT(
            (in->volume.geometry.position_of({double(i), double(j), double(k)}) - at_m).norm(),
            1e-12);
        EXPECT_EQ(in->volume.value(i, j, k), 100 * k + 10 * j + i - 50);
      }
}

/// A gzip stream's bytes.
core::Bytes zipped(const core::Bytes& data) {
  const Scratch folder;
  test_support::put_gzip(folder / "z", data);
  core::Bytes out(fs::file_size(folder / "z"));
  std::FILE* file = std::fopen((folder / "z").c_str(), "rb");
  EXPECT_EQ(std::fread(out.data(), 1, out.size(), file), out.size());
  std::fclose(file);
  return out;
}

TEST(Nrrd, PlacesEveryVoxelInEachNamedSpace) {
  expect_voxels(read_nrrd({}));
  expect_voxels(read_nrrd({.space = "LPS"}));
  expect_voxels(read_nrrd({.space = "right-anterior-superior"}), {-1, -1, 1});
  expect_voxels(read_nrrd({.space = "RAS"}), {-1, -1, 1});
  expect_voxels(read_nrrd({.space = "left-anterior-superior"}), {1, -1, 1});
}

TEST(Nrrd, ScannerSpaceIsTakenAsHeadFirstSupineAndThatIsSaid) {
  const auto in = read_nrrd({.space = "scanner-xyz"});
  expect_voxels(in);
  ASSERT_EQ(in->notes.size(), 1u);
  EXPECT_NE(in->notes[0].find("head first"), std::string::npos);
}

TEST(Nrrd, ReadsBigEndianGzipAndDetachedToTheSameVolume) {
  expect_voxels(read_nrrd({.endian = "big"}, voxels(true)));
  expect_voxels(read_nrrd({.encoding = "gzip"}, zipped(voxels())));
  expect_voxels(read_nrrd({.endian = "big", .encoding = "gz"}, zipped(voxels(true))));
  const Scratch folder;
  fs::create_directory(folder / "sub");
  test_support::put(folder / "sub/v.raw", voxels());
  test_support::put(folder / "v.nhdr",
                    core::bytes_of(Header{.more = "data file: sub/v.raw\n"}.text()));
  expect_voxels(volume_io::read_volume(folder / "v.nhdr"));
  test_support::put_gzip(folder / "v.raw.gz", voxels());
  test_support::put(
      folder / "z.nhdr",
      core::bytes_of(Header{.encoding = "gzip", .more = "data file: v.raw.gz\n"}.text()));
  expect_voxels(volume_io::read_volume(folder / "z.nhdr"));
}

TEST(Nrrd, UnitsOtherThanMillimetresAreFollowed) {
  const auto in = read_nrrd({.directions = "(0.001,0,0) (0,0.001,0) (0,0,0.001)",
                             .origin = "(0.1,0.2,0.3)",
                             .more = "space units: \"m\" \"m\" \"m\"\n"});
  ASSERT_TRUE(in) << in.error().what;
  EXPECT_LT((in->volume.geometry.position_of({1, 2, 3}) - Vec3(0.101, 0.202, 0.303)).norm(), 1e-12);
}

struct NrrdLie {
  const char* name;
  Header header;
  const char* word;
};

class NrrdLies : public testing::TestWithParam<NrrdLie> {};

TEST_P(NrrdLies, IsRefusedInOneLineThatNamesTheFileAndThePlace) {
  const auto in = read_nrrd(GetParam().header);
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("v.nrrd: "), std::string::npos) << in.error().what;
  EXPECT_NE(in.error().what.find(GetParam().word), std::string::npos) << in.error().what;
  EXPECT_EQ(in.error().what.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, NrrdLies,
    testing::Values(
        NrrdLie{"Billions", {.sizes = "1000000000 1000000000 1000000000"}, "sizes: axis 1"},
        NrrdLie{"Negative", {.sizes = "5 -4 3"}, "sizes: axis 2"},
        NrrdLie{"Text", {.sizes = "5 four 3"}, "sizes"},
        NrrdLie{"Overflow", {.sizes = "99999999999999999999999999 4 3"}, "sizes"},
        NrrdLie{"Fraction", {.sizes = "5 4 3.5"}, "sizes"},
        NrrdLie{"TooManyVoxels", {.sizes = "4000 4000 4000"}, "4000 × 4000"},
        NrrdLie{"MoreThanTheFileHas", {.sizes = "5 4 4"}, "bytes, its header declares"},
        NrrdLie{"LessThanTheFileHas", {.sizes = "5 4 2"}, "bytes, its header declares"},
        NrrdLie{"FourDimensions", {.dimension = "4"}, "dimension"},
        NrrdLie{"NoSpace", {.space = ""}, "line 5"},
        NrrdLie{"UnknownSpace", {.space = "3D-right-handed"}, "space \"3d-right-handed\""},
        NrrdLie{"NanSpacing", {.directions = "(nan,0,0) (0,1,0) (0,0,1)"}, "space directions"},
        NrrdLie{"Sheared", {.directions = "(1,0.2,0) (0,1,0) (0,0,1)"}, "right angles"},
        NrrdLie{"TwoDirections", {.directions = "(1,0,0) (0,1,0)"}, "space directions"},
        NrrdLie{"InfiniteOrigin", {.origin = "(inf,0,0)"}, "origin"},
        NrrdLie{"Block", {.type = "block"}, "type \"block\""},
        NrrdLie{"Bzip", {.encoding = "bzip2"}, "encoding \"bzip2\""},
        NrrdLie{"NotReallyGzip", {.encoding = "gzip"}, "no gzip stream begins"},
        NrrdLie{"Skip", {.more = "byte skip: 100\n"}, "byte skip"},
        NrrdLie{"TwiceSaid", {.more = "encoding: gzip\n"}, "a second \"encoding\""},
        NrrdLie{"UnknownField", {.more = "execute: rm\n"}, "line 12: the field \"execute\""},
        NrrdLie{"Passwords",
                {.more = "data file: ../../../../etc/passwd\n"},
                "within the header's own folder"},
        NrrdLie{"Absolute", {.more = "data file: /etc/passwd\n"}, "within the header's own folder"},
        NrrdLie{"PasswordsInAPair",
                {.more = "data file: ../v.raw:=x\n"},
                "within the header's own folder"},
        NrrdLie{"Missing", {.more = "data file: nowhere.raw\n"}, "there is no such file"},
        NrrdLie{"Pattern", {.more = "data file: s%03d.raw 1 9 1\n"}, "several files"}),
    [](const auto& named) { return std::string(named.param.name); });

TEST(Nrrd, RandomDamageIsReadOrRefusedAndNothingElse) {
  std::mt19937 random(3);
  const core::Bytes plain = joined(Header{}.text() + "\n", voxels());
  const core::Bytes gzip = joined(Header{.encoding = "gzip"}.text() + "\n", zipped(voxels()));
  const Scratch folder;
  for (int n = 0; n < 3000; ++n) {
    core::Bytes bytes = n % 2 ? plain : gzip;
    for (int d = 0; d < 3; ++d) bytes[8 + random() % 300] = static_cast<std::byte>(random());
    if (n % 5 == 0) bytes.resize(random() % bytes.size());
    test_support::put(folder / "v.nrrd", bytes);
    const auto in = volume_io::read_volume(folder / "v.nrrd");
    if (in)
      EXPECT_EQ(in->volume.counts.size(), in->volume.geometry.voxel_count());
    else
      EXPECT_EQ(in.error().what.find('\n'), std::string::npos) << in.error().what;
  }
}

TEST(Nrrd, ALinkThatLeadsOutOfTheFolderIsRefused) {
  const Scratch folder;
  fs::create_symlink("/etc/passwd", folder / "v.raw");
  test_support::put(folder / "v.nhdr", core::bytes_of(Header{.more = "data file: v.raw\n"}.text()));
  const auto in = volume_io::read_volume(folder / "v.nhdr");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("leads out of the header's own folder"), std::string::npos)
      << in.error().what;
}

TEST(Nrrd, GzipThatInflatesToMoreThanDeclaredIsRefused) {
  const Scratch folder;
  test_support::put_gzip_of_zeros(folder / "v.gz", {}, 64u << 20);
  test_support::put(folder / "v.nhdr",
                    core::bytes_of(Header{.encoding = "gzip", .more = "data file: v.gz\n"}.text()));
  const auto in = volume_io::read_volume(folder / "v.nhdr");
  ASSERT_FALSE(in);
  EXPECT_NE(in.error().what.find("inflates to more than the 120 bytes"), std::string::npos)
      << in.error().what;
}

}  // namespace
}  // namespace tractus
