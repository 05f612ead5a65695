/// ω∗α: opacity by the transfer function and the published Gaussian over it, in one pass over the
/// counts.
#pragma once

#include <array>
#include <cstddef>

#include "core/progress.hpp"
#include "volume/opacity_ramps.hpp"
#include "volume/scalar_grid.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// Half of the published 15 taps: how far a voxel reaches, in voxels per axis.
inline constexpr int kBlurReach = 7;

/// Writes ω∗α into `grid` over `box` (not empty, within the volume), whatever was there before:
///
///     (ω∗α)(i) = Σ_{k = −7…7} w_k α(i + k),   w_k = exp(−k²/2) / Σ_{m = −7…7} exp(−m²/2)      per
///     axis
///
/// The voxels at the edges repeat outward. The outermost taps weigh 9e-12, a thousandth of a
/// float's rounding of the sum, and are left out. A voxel's value does not depend on the box it was
/// computed in, to the last bit. Up to seven voxels of a row beyond the box may be written too,
/// with the values that are theirs. Large boxes are split over threads. False when `progress` asked
/// to stop; the grid is then half written.
bool blur(const Volume& volume, const OpacityRamps& ramps, const Box& box,
          const core::Progress& progress, ScalarGrid& grid);

/// Floats [k][j][i] that stand for a part of a volume, from voxel `begin` on.
struct BlurTarget {
  float* first;
  std::array<int, 3> begin;
  std::ptrdiff_t row_pitch, slice_pitch;  ///< floats from row to row, from slice to slice

  float* at(int i, int j, int k) const noexcept {
    return first + ((k - begin[2]) * slice_pitch + (j - begin[1]) * row_pitch + (i - begin[0]));
  }
};

/// The same values into other memory. Rows are written from the multiple of eight before the box to
/// the one behind it: there `target` must have room.
void blur(const Volume& volume, const OpacityRamps& ramps, const Box& box,
          const BlurTarget& target);

}  // namespace tractus::volume
