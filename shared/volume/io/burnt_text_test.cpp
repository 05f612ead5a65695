/// Text in the pixels: found where it is written, not where there is none.
#include "volume/io/burnt_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <checkout.hpp>
#include <cmath>
#include <filesystem>
#include <random>

#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {
using volume::Volume;

/// A 5 × 7 font, column by column, least bit at the top: the usual one of matrix displays.
constexpr std::array<std::pair<char, std::array<unsigned, 5>>, 12> kFont{{
    {'A', {0x7e, 0x11, 0x11, 0x11, 0x7e}},
    {'D', {0x7f, 0x41, 0x41, 0x22, 0x1c}},
    {'E', {0x7f, 0x49, 0x49, 0x49, 0x41}},
    {'H', {0x7f, 0x08, 0x08, 0x08, 0x7f}},
    {'M', {0x7f, 0x02, 0x0c, 0x02, 0x7f}},
    {'N', {0x7f, 0x04, 0x08, 0x10, 0x7f}},
    {'O', {0x3e, 0x41, 0x41, 0x41, 0x3e}},
    {'R', {0x7f, 0x09, 0x19, 0x29, 0x46}},
    {'S', {0x46, 0x49, 0x49, 0x49, 0x31}},
    {'T', {0x01, 0x01, 0x7f, 0x01, 0x01}},
    {'1', {0x00, 0x42, 0x7f, 0x40, 0x00}},
    {'7', {0x01, 0x71, 0x09, 0x05, 0x03}},
}};

/// Simulated: noisy air round a noisy ellipse of tissue with a ring of bone; 160 × 160 × 8.
Volume slices(unsigned seed) {
  Volume v;
  v.geometry.dims = {160, 160, 8};
  v.geometry.spacing_m = {1e-3, 1e-3, 3e-3};
  v.intercept = -1024.0;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 20.0);
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 160; ++j)
      for (int i = 0; i < 160; ++i) {
        const double r = std::hypot((i - 80) / 70.0, (j - 80) / 55.0);
        const double bone = std::hypot(i - 80.0, j - 95.0 + k);
        const double value = r > 1.0 ? -1000.0 : bone > 12.0 && bone < 17.0 ? 900.0 : 40.0;
        v.counts.push_back(
            static_cast<std::uint16_t>(std::clamp(value + 1024.0 + noise(random), 0.0, 4095.0)));
      }
  return v;
}

void write(Volume& v, const std::string& words, int left, int top, int size, int k,
           std::uint16_t ink) {
  for (std::size_t n = 0; n < words.size(); ++n)
    for (const auto& [letter, columns] : kFont)
      if (letter == words[n])
        for (int x = 0; x < 5 * size; ++x)
          for (int y = 0; y < 7 * size; ++y)
            if (columns[std::size_t(x / size)] >> (y / size) & 1)
              v.counts[v.offset(left + static_cast<int>(n) * 6 * size + x, top + y, k)] = ink;
}

TEST(BurntText, IsFoundInEveryCornerInSeveralSizes) {
  for (const int size : {1, 2})
    for (const auto& [left, top, place] : {std::tuple(4, 6, "top left"),
                                           {90, 6, "top right"},
                                           {4, 135, "bottom left"},
                                           {90, 135, "bottom right"}}) {
      Volume v = slices(1);
      for (int k = 0; k < 8; ++k) write(v, "MODERN", left, top, size, k, 4095);
      const auto found = volume_io::text_suspicions(v);
      ASSERT_FALSE(found.empty()) << place << size;
      std::string all;
      for (const auto& line : found) all += line + "\n";
      EXPECT_NE(all.find(std::string("at the ") + place + " of 8 of 8"), std::string::npos) << all;
    }
}

TEST(BurntText, IsFoundInOneSliceOfManyAndDarkOnBright) {
  Volume v = slices(2);
  write(v, "SMITH71", 10, 8, 1, 5, 4095);
  EXPECT_FALSE(volume_io::text_suspicions(v).empty());
  Volume bright = slices(3);
  for (auto& count : bright.counts) count = static_cast<std::uint16_t>(4095 - count);
  write(bright, "ANDERS", 10, 8, 1, 2, 0);
  EXPECT_FALSE(volume_io::text_suspicions(bright).empty());
}

TEST(BurntText, IsNotFoundInNoiseBoneOrSimulatedTissue) {
  for (unsigned seed = 10; seed < 20; ++seed)
    for (const auto& line : volume_io::text_suspicions(slices(seed))) ADD_FAILURE() << line;
}

TEST(BurntText, IsNotFoundInTheRealScansOfTheTests) {
  int read = 0;
  const std::filesystem::path data = std::string(checkout::kSource) + "/tests/data/ct";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const std::string name = entry.path().filename().string();
    if (name != "ct_cropped.nii.gz" && name != "example_ct.nii.gz" &&
        name != "sub-ct_label-22_ct.nii.gz")
      continue;
    const auto in = volume_io::read_volume(entry.path());
    ASSERT_TRUE(in) << in.error().what;
    ++read;
    for (const auto& line : volume_io::text_suspicions(in->volume))
      ADD_FAILURE() << entry.path() << ": " << line;
  }
  EXPECT_EQ(read, 3);
}

}  // namespace
}  // namespace tractus
