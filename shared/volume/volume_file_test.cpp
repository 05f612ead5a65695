/// The store format: what is written comes back, in whole and in part, and nothing damaged is
/// believed.
#include "volume/volume_file.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <random>

#include "core/file.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using volume::Box;
using volume::Volume;
using volume::VolumeFile;

/// Simulated: a ball of bone in air with seeded noise; 70 × 65 × 66 makes 2 × 2 × 2 bricks, seven
/// of them clipped.
Volume ball() {
  Volume v;
  v.geometry.dims = {70, 65, 66};
  v.geometry.spacing_m = {0.7e-3, 0.8e-3, 1.25e-3};
  v.geometry.origin_m = {-0.1, 0.02, 0.3};
  v.geometry.directions =
      Eigen::AngleAxisd(0.3, volume::Vec3(1, 2, 3).normalized()).toRotationMatrix();
  v.slope = 0.5;
  v.intercept = -1024.0;
  std::mt19937 random(7);
  for (int k = 0; k < 66; ++k)
    for (int j = 0; j < 65; ++j)
      for (int i = 0; i < 70; ++i) {
        const bool inside = (i - 35) * (i - 35) + (j - 32) * (j - 32) + (k - 33) * (k - 33) < 900;
        v.counts.push_back(static_cast<std::uint16_t>((inside ? 3000 : 100) + random() % 64));
      }
  return v;
}

class VolumeStore : public testing::Test {
 protected:
  VolumeStore() {
    std::string name = (fs::temp_directory_path() / "tractus-volume-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~VolumeStore() override { fs::remove_all(folder_); }
  fs::path path(const char* name = "v.tvol") const { return folder_ / name; }
  core::Bytes bytes() const { return core::read_file(path()).value(); }
  void put(const core::Bytes& content) const { ASSERT_TRUE(core::write_file(path(), content)); }
  fs::path folder_;
};

TEST_F(VolumeStore, GivesBackEveryVoxelAndTheGeometryToTheBit) {
  const Volume v = ball();
  const auto id = volume::write_volume(path(), v, {"ball", "simulated"});
  ASSERT_TRUE(id) << id.error().what;
  const auto file = VolumeFile::open(path());
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_EQ(file->id(), *id);
  EXPECT_EQ(file->brick_count(), 8u);
  EXPECT_EQ(file->meta().source, "ball");
  EXPECT_EQ(file->meta().note, "simulated");
  const auto back = file->read_all();
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->counts, v.counts);
  EXPECT_EQ(back->geometry.dims, v.geometry.dims);
  EXPECT_EQ(back->geometry.spacing_m, v.geometry.spacing_m);
  EXPECT_EQ(back->geometry.origin_m, v.geometry.origin_m);
  EXPECT_EQ(back->geometry.directions, v.geometry.directions);
  EXPECT_EQ(back->slope, v.slope);
  EXPECT_EQ(back->intercept, v.intercept);
}

TEST_F(VolumeStore, ReadsABoxAcrossBricksWithTheGeometryItHasThere) {
  const Volume v = ball();
  ASSERT_TRUE(volume::write_volume(path(), v, {}));
  const auto file = VolumeFile::open(path());
  ASSERT_TRUE(file);
  const Box box{{60, 3, 62}, {70, 65, 66}};
  const auto part = file->read_box(box);
  ASSERT_TRUE(part) << part.error().what;
  ASSERT_EQ(part->geometry.dims, (std::array{10, 62, 4}));
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 62; ++j)
      for (int i = 0; i < 10; ++i) ASSERT_EQ(part->value(i, j, k), v.value(i + 60, j + 3, k + 62));
  EXPECT_LT((part->geometry.position_of({1, 2, 3}) - v.geometry.position_of({61, 5, 65})).norm(),
            1e-15);
}

TEST_F(VolumeStore, RefusesABoxThatLeavesTheVolume) {
  ASSERT_TRUE(volume::write_volume(path(), ball(), {}));
  const auto file = VolumeFile::open(path());
  for (const Box& box :
       {Box{{0, 0, 0}, {71, 1, 1}}, Box{{-1, 0, 0}, {5, 5, 5}}, Box{{3, 3, 3}, {3, 4, 4}}}) {
    const auto part = file->read_box(box);
    ASSERT_FALSE(part);
    EXPECT_EQ(part.error().code, core::Errc::out_of_range);
  }
}

TEST_F(VolumeStore, TheIdNamesTheContentAndNothingElse) {
  Volume v = ball();
  const auto first = volume::write_volume(path("a.tvol"), v, {"s", "n"});
  const auto again = volume::write_volume(path("b.tvol"), v, {"s", "n"});
  EXPECT_EQ(*first, *again);
  v.counts[4711] ^= 1;
  EXPECT_NE(*first, volume::write_volume(path(), v, {"s", "n"}).value());
  v.counts[4711] ^= 1;
  v.geometry.origin_m.x() += 1e-9;
  EXPECT_NE(*first, volume::write_volume(path(), v, {"s", "n"}).value());
}

TEST_F(VolumeStore, TheIdIsTheShaOfHeaderAndBrickDigestsAsTheFormatSays) {
  // Read by the format's description alone: header at 16, index after it, digests of the
  // decompressed bytes.
  Volume v = ball();
  v.geometry.dims = {5, 3, 2};
  v.counts.resize(30);
  const auto id = volume::write_volume(path(), v, {"s", "n"});
  const core::Bytes file = bytes();
  std::uint32_t header = 0, length = 0;
  std::memcpy(&header, file.data() + 12, 4);
  std::memcpy(&length, file.data() + 16 + header, 4);
  ASSERT_EQ(file.size(), 16 + header + 36 + length);
  std::array<std::uint8_t, 60> planes{};
  ASSERT_EQ(ZSTD_decompress(planes.data(), 60, file.data() + 16 + header + 36, length), 60u);
  std::string voxels;
  for (std::size_t n = 0; n < 30; ++n) {
    EXPECT_EQ(planes[n] + 256 * planes[30 + n], v.counts[n]);
    voxels += {static_cast<char>(planes[n]), static_cast<char>(planes[30 + n])};
  }
  const core::ByteView digest = core::ByteView(file).subspan(16 + header + 4, 32);
  EXPECT_EQ(core::hex(digest), core::sha256(core::bytes_of(voxels)));
  core::Sha256 name;
  name.add(core::ByteView(file).subspan(16, header));
  name.add(digest);
  EXPECT_EQ(*id, name.hex());
}

TEST_F(VolumeStore, TruncatedAnywhereIsRefused) {
  ASSERT_TRUE(volume::write_volume(path(), ball(), {}));
  const core::Bytes whole = bytes();
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 9) {
    put(core::Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    const auto file = VolumeFile::open(path());
    ASSERT_FALSE(file) << size;
    EXPECT_NE(file.error().what.find(path().string()), std::string::npos);
  }
}

TEST_F(VolumeStore, OneWrongBitAnywhereIsNoticedOrChangesTheId) {
  const Volume v = ball();
  const auto id = volume::write_volume(path(), v, {});
  const core::Bytes whole = bytes();
  std::mt19937 random(11);
  for (int n = 0; n < 200; ++n) {
    core::Bytes damaged = whole;
    const std::size_t at = n < 100 ? random() % 2000 : random() % whole.size();
    damaged[at] ^= static_cast<std::byte>(1u << random() % 8);
    put(damaged);
    const auto file = VolumeFile::open(path());
    if (!file || file->id() != *id) continue;
    EXPECT_FALSE(file->read_all()) << "byte " << at;
  }
}

TEST_F(VolumeStore, APartIsReadThoughAnotherBrickIsDamaged) {
  const Volume v = ball();
  ASSERT_TRUE(volume::write_volume(path(), v, {}));
  core::Bytes damaged = bytes();
  damaged[damaged.size() - 20] ^= std::byte{4};  // in the last brick
  put(damaged);
  const auto file = VolumeFile::open(path());
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->read_box({{0, 0, 0}, {64, 64, 64}}));
  const auto all = file->read_all();
  ASSERT_FALSE(all);
  EXPECT_EQ(all.error().code, core::Errc::corrupt);
  EXPECT_NE(all.error().what.find("brick 7 of 8"), std::string::npos) << all.error().what;
}

TEST_F(VolumeStore, StoppingLeavesNothingBehindAndTheOldFileAsItWas) {
  put(core::Bytes(3, std::byte{9}));
  const auto id = volume::write_volume(path(), ball(), {}, [](double) { return false; });
  ASSERT_FALSE(id);
  EXPECT_EQ(id.error().code, core::Errc::cancelled);
  EXPECT_EQ(bytes().size(), 3u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(VolumeStore, RefusesGeometryThatNoReaderWouldTake) {
  const auto refused = [&](auto&& change) {
    Volume v = ball();
    change(v);
    return !volume::write_volume(path(), v, {});
  };
  EXPECT_TRUE(refused([](Volume& v) { v.geometry.spacing_m.y() = 0.0; }));
  EXPECT_TRUE(refused([](Volume& v) { v.geometry.spacing_m.y() = std::nan(""); }));
  EXPECT_TRUE(refused([](Volume& v) { v.geometry.directions(0, 0) += 0.01; }));
  EXPECT_TRUE(refused([](Volume& v) { v.slope = -1.0; }));
  EXPECT_TRUE(refused([](Volume& v) { v.geometry.origin_m.z() = INFINITY; }));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(VolumeHistogram, CountsByHand) {
  // Counts 10, 10, 11, 13 at slope 2, intercept 100: values 120, 120, 122, 126; span 3 fits bins of
  // one count each.
  Volume v;
  v.geometry.dims = {4, 1, 1};
  v.slope = 2.0;
  v.intercept = 100.0;
  v.counts = {10, 11, 13, 10};
  const auto h = volume::histogram_of(v);
  EXPECT_EQ(h.low, 120.0);
  EXPECT_EQ(h.width, 2.0);
  EXPECT_EQ(h.voxels, (std::vector<std::uint64_t>{2, 1, 0, 1}));
  EXPECT_EQ(volume::value_range_of(v), (std::array{120.0, 126.0}));
  v.counts = {0, 65535, 65535, 256};  // span 65535: 256 bins of 256 counts
  const auto wide = volume::histogram_of(v);
  EXPECT_EQ(wide.voxels.size(), 256u);
  EXPECT_EQ(wide.width, 512.0);
  EXPECT_EQ(wide.voxels[0], 1u);
  EXPECT_EQ(wide.voxels[1], 1u);
  EXPECT_EQ(wide.voxels[255], 2u);
}

}  // namespace
}  // namespace tractus
