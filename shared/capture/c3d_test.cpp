#include "capture/c3d.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <checkout.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "capture/force.hpp"
#include "capture/motion.hpp"
#include "core/bytes.hpp"

namespace tractus {
namespace capture {
namespace {
namespace fs = std::filesystem;
using math::Vec3;

const fs::path kGolden = std::string(checkout::kSource) + "/tests/golden/c3d";

// The numbers of tests/golden/c3d/make.py: multiples of 0.25, exact in any of the six files.
class EveryC3d : public testing::TestWithParam<const char*> {
 protected:
  fs::path file() const { return kGolden / (std::string(GetParam()) + ".c3d"); }
};

TEST_P(EveryC3d, GivesBackItsPointsAndChannels) {
  const auto read = read_c3d_file(file());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->rate_Hz, 50.0);
  EXPECT_EQ(read->analog_rate_Hz, 150.0);
  EXPECT_EQ(read->points, (std::vector<std::string>{"tip", "top"}));
  ASSERT_EQ(read->p_C_m.size(), 8u);
  for (int k = 0; k < 4; ++k) {
    const Vec3 tip(10.0 * k + 1.5, -20.25 - k, 300.0 + 2.0 * k), top(0.5, 1000.0 - k, -0.75);
    EXPECT_LT((read->p_C_m[std::size_t(2 * k)] - 1e-3 * tip).norm(), 1e-12);
    if (k == 2)
      EXPECT_TRUE(std::isnan(read->p_C_m[5].x()));
    else
      EXPECT_LT((read->p_C_m[std::size_t(2 * k + 1)] - 1e-3 * top).norm(), 1e-12);
  }
  ASSERT_EQ(read->analog.size(), 6u);
  for (std::size_t n = 0; n < 12; ++n) {
    EXPECT_EQ(read->analog[0].values[n], double(n) + 0.5);
    EXPECT_EQ(read->analog[3].values[n], 100.0 * double(n));
  }
}

TEST_P(EveryC3d, IsAMotionAndAForce) {
  const auto motion = read_motion(file());
  ASSERT_TRUE(motion) << motion.error().what;
  EXPECT_EQ(motion->markers.at("tip").t_s, (std::vector<double>{0.0, 0.02, 0.04, 0.06}));
  EXPECT_EQ(motion->markers.at("top").t_s, (std::vector<double>{0.0, 0.02, 0.06}));
  const auto force = read_force(file());
  ASSERT_TRUE(force) << force.error().what;
  ASSERT_EQ(force->t_s.size(), 12u);
  EXPECT_NEAR(force->t_s[4], 4.0 / 150.0, 1e-12);
  EXPECT_EQ(force->wrench_S[4].force_N, Vec3(4.5, -8.0, 10.0));
  EXPECT_LT((force->wrench_S[4].torque_Nm - Vec3(0.4, -0.05, 0.001)).norm(), 1e-12);  // of N mm
}

INSTANTIATE_TEST_SUITE_P(Golden, EveryC3d,
                         testing::Values("intel_real", "intel_integer", "dec_real", "dec_integer",
                                         "mips_real", "mips_integer"),
                         [](const auto& file) { return std::string(file.param); });

/// A C3D file as c3d.org lays it out (Intel, integers, one point): header, one block of parameters,
/// frames, and zeros to the end of the last block.
class LongC3d {
 public:
  explicit LongC3d(std::size_t frames) : frames_(frames), bytes_(1024) {
    bytes_[0] = std::byte{2}, bytes_[1] = std::byte{0x50};
    word(2, 1), word(6, 1), word(8, std::min<std::size_t>(frames, 65535)), word(16, 3);
    real(12, 1.0F), real(20, 100.0F);
    bytes_[512] = std::byte{1}, bytes_[513] = std::byte{0x50};
    bytes_[514] = std::byte{1}, bytes_[515] = std::byte{84};
    group(1, "POINT"), group(2, "TRIAL");
    parameter(1, "FRAMES", {std::min<std::size_t>(frames, 65535)});
  }
  void group(int number, const std::string& name) {
    begin(name, -number, 3);
    ++at_;
  }
  void parameter(int group, const std::string& name, const std::vector<std::size_t>& words) {
    begin(name, group, 5 + 2 * words.size());
    bytes_[at_] = std::byte{2}, bytes_[at_ + 1] = std::byte{1};
    bytes_[at_ + 2] = std::byte(words.size());
    at_ += 3;
    for (const std::size_t w : words) word(at_, w), at_ += 2;
  }
  fs::path write(const std::string& name) {
    for (std::size_t f = 0; f < frames_; ++f)
      for (const std::size_t v : {f % 1000 + 1, std::size_t{2}, std::size_t{3}, std::size_t{0}}) {
        bytes_.push_back(std::byte(v)), bytes_.push_back(std::byte(v >> 8));
      }
    bytes_.resize((bytes_.size() + 511) / 512 * 512);
    const fs::path path = fs::temp_directory_path() / (name + core::new_id() + ".c3d");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes_.data()), std::streamsize(bytes_.size()));
    return path;
  }

 private:
  void begin(const std::string& name, int group, std::size_t to_next) {
    bytes_[at_] = std::byte(name.size()), bytes_[at_ + 1] = std::byte(group);
    for (std::size_t k = 0; k < name.size(); ++k) bytes_[at_ + 2 + k] = std::byte(name[k]);
    at_ += 2 + name.size();
    word(at_, to_next);
    at_ += 2;
  }
  void word(std::size_t at, std::size_t v) {
    bytes_[at] = std::byte(v), bytes_[at + 1] = std::byte(v >> 8);
  }
  void real(std::size_t at, float v) { std::memcpy(&bytes_[at], &v, 4); }
  std::size_t frames_, at_ = 516;
  std::vector<std::byte> bytes_;
};

// The frames' count has 16 bits: without a sign it reaches to 65535, and longer recordings are
// stated by TRIAL's fields (low word first). What fills the last block is no frame.
TEST(LongC3dFile, HasAsManyFramesAsItSays) {
  const auto frames_of = [](const fs::path& path) {
    const auto read = read_c3d_file(path);
    fs::remove(path);
    return read ? read->frames : 0;
  };
  EXPECT_EQ(frames_of(LongC3d(40'001).write("forty")), 40'001u);
  LongC3d longer(70'001);
  longer.parameter(2, "ACTUAL_START_FIELD", {1, 0});
  longer.parameter(2, "ACTUAL_END_FIELD", {70'001 & 0xffff, 70'001 >> 16});
  EXPECT_EQ(frames_of(longer.write("seventy")), 70'001u);
}

TEST(C3dForce, NamesTheChannelThatIsMissing) {
  const auto none =
      read_force(kGolden / "intel_real.c3d", {"Fx", "Fy", "Force.Z", "Mx", "My", "Mz"});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("'Force.Z'"), std::string::npos) << none.error().what;
  EXPECT_NE(none.error().what.find("'Fz'"), std::string::npos);  // one of those that there are
  const auto swapped = read_force(kGolden / "intel_real.c3d", {"Mx", "Fy", "Fz", "Mx", "My", "Mz"});
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().what.find("'Nmm'"), std::string::npos) << swapped.error().what;
}

// A device whose second is 1.0143 of ours (a rate that was rounded up), its samples late by up to
// 30 ms, in bursts, and never early.
TEST(DeviceRate, IsToldByTheLeastLateSamples) {
  std::vector<double> t_s, arrived_s;
  unsigned random = 7;
  for (int k = 0; k < 20'000; ++k) {
    random = random * 1664525u + 1013904223u;
    const double late_s = (k / 500) % 3 == 0 ? 0.03 * double(random >> 8) / double(1 << 24) : 2e-4;
    t_s.push_back(0.001 * k);
    arrived_s.push_back(3.0 + 1.0143 * t_s.back() + late_s);
  }
  const auto rate = device_rate(t_s, arrived_s);
  ASSERT_TRUE(rate) << rate.error().what;
  EXPECT_NEAR(*rate, 1.0143, 1e-5);
}

TEST(DeviceRate, RefusesClocksThatAreNotOfOneRecording) {
  std::vector<double> t_s, arrived_s;
  for (int k = 0; k < 1000; ++k) t_s.push_back(0.01 * k), arrived_s.push_back(0.02 * k);
  EXPECT_FALSE(device_rate(t_s, arrived_s));
  EXPECT_EQ(*device_rate(std::span(t_s).first(50), std::span(arrived_s).first(50)), 1.0);
}

}  // namespace
}  // namespace capture
}  // namespace tractus
