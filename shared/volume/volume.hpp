/// A CT volume: voxels with their place in the patient.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/geometry.hpp"

namespace tractus::volume {

using math::Mat3;
using math::Vec3;

/// Where voxels lie. The volume's frame V is the patient's: LPS (x to the patient's left, y to
/// posterior, z to superior), metres. Voxel (i, j, k) is centred at origin + directions · (i dx, j
/// dy, k dz).
struct Geometry {
  std::array<int, 3> dims{};      ///< voxels along i, j, k
  Vec3 spacing_m = Vec3::Ones();  ///< > 0
  Vec3 origin_m = Vec3::Zero();   ///< centre of voxel (0, 0, 0)
  Mat3 directions =
      Mat3::Identity();  ///< columns: unit vectors of i, j, k in V; orthonormal, may be left-handed

  std::size_t voxel_count() const {
    return std::size_t(dims[0]) * std::size_t(dims[1]) * std::size_t(dims[2]);
  }
  /// Continuous voxel index of a point: integers at voxel centres.
  Vec3 index_of(const Vec3& p_V_m) const {
    return (directions.transpose() * (p_V_m - origin_m)).cwiseQuotient(spacing_m);
  }
  Vec3 position_of(const Vec3& index) const {
    return origin_m + directions * index.cwiseProduct(spacing_m);
  }
  /// Inside the box of the voxel centres?
  bool contains(const Vec3& p_V_m) const {
    const Vec3 at = index_of(p_V_m);
    for (int a = 0; a < 3; ++a)
      if (!(at[a] >= 0.0 && at[a] <= dims[std::size_t(a)] - 1)) return false;
    return true;
  }
};

/// Half-open box of voxel indices.
struct Box {
  std::array<int, 3> begin{}, end{};
};

/// Voxels as 16-bit counts; the CT value (HU where the source is calibrated) is intercept + slope ·
/// count.
struct Volume {
  Geometry geometry;
  double slope = 1.0;
  double intercept = 0.0;
  std::vector<std::uint16_t> counts;  ///< [k][j][i], geometry.voxel_count() of them

  std::size_t offset(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(geometry.dims[1]) + std::size_t(j)) *
               std::size_t(geometry.dims[0]) +
           std::size_t(i);
  }
  double value(int i, int j, int k) const { return intercept + slope * counts[offset(i, j, k)]; }
  /// The count nearest to a CT value, within what a count can hold.
  std::uint16_t count_of(double value) const;
  /// CT value at a point by trilinear interpolation; outside, the edge voxel's.
  double value_at(const Vec3& p_V_m) const;
};

}  // namespace tractus::volume
