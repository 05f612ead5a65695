#pragma once
/// A CT volume with a tract in it: made up, or cut from a real scan. Axes along the patient's
/// (LPS).
#include <Eigen/Dense>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "support/random.hpp"

namespace blind {

using Vec3 = Eigen::Vector3d;

struct Volume {
  std::array<int, 3> size{};  ///< x, y, z
  Vec3 spacing_m{0, 0, 0}, origin_m{0, 0, 0};
  std::vector<double> hu;  ///< [z][y][x]

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3 centre_m() const;
};

/// The channel: from `entry_m` along `along` for `depth_m`, its wall a little out of round.
struct Tract {
  Vec3 entry_m, along, across, up;
  double depth_m = 0.03, radius_m = 0.0022;
  std::array<double, 6> wall{};  ///< amplitudes and phases of the wall's waves

  double radius_at(double depth_m, double angle_rad) const;
};

/// A block of cancellous bone under a cortical shell, textured, 96³ voxels of 0.5 mm.
Volume bone_block(Random& random);

/// 48 mm about the bone of a real scan, resampled to 0.5 mm by three-linear interpolation. Empty
/// when it cannot be read.
std::optional<Volume> real_bone(const std::filesystem::path& nifti_gz);

Tract draw_tract(Random& random, const Volume& volume);

/// Empties the tract to `inside_hu`, partial volumes at its wall kept; a rim of `rim_hu` added
/// around it when > 0.
void carve(Volume& volume, const Tract& tract, double inside_hu, double rim_hu);

bool write_nrrd(const Volume& volume, const std::filesystem::path& file);

}  // namespace blind
