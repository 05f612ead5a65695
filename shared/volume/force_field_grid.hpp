/// What a ForceField holds. For its own sources alone: force_field.cpp makes it, field_sampling.cpp
/// reads it.
#pragma once

#include <atomic>
#include <optional>
#include <utility>

#include "volume/force_field.hpp"
#include "volume/opacity_ramps.hpp"
#include "volume/scalar_grid.hpp"

namespace tractus::volume {

struct ForceField::Grid {
  /// @param part  the voxels that are known
  Grid(const Geometry& of_volume, FieldKind kind_of_field, const Box& part, ScalarGrid scalars);

  /// Three columns of a 3 × 3 matrix or a vector, each with a fourth number that is zero.
  struct alignas(32) Column {
    double v[4];
  };

  Geometry geometry;
  FieldKind kind;
  std::optional<OpacityRamps> ramps;  ///< of a whole field
  ScalarGrid blurred;                 ///< ω∗α
  Mat3 V_from_index;                  ///< of gradients: directions / spacing, 1/m
  Column g_of[3];                     ///< −V_from_index
  Column index_of[3];  ///< u = index_of · p + index_at_origin, u the continuous voxel index of p
  Column index_at_origin;
  alignas(16) int known_begin[4];  ///< of `part`
  alignas(16) int known_end[4];    ///< the fourth is beyond all there is
  mutable std::atomic<bool> left_part = false;
};

}  // namespace tractus::volume
