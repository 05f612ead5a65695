/// Cutting a part out of a volume, on a finer grid where the source is coarse.
#pragma once

#include <span>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

inline constexpr std::size_t kMaxResampledVoxels = std::size_t(1) << 28;  ///< 512 MiB of counts

/// The voxels within `margin_m` of any of the points, along the volume's axes; clipped to the
/// volume, never empty.
Box box_about(const Geometry& geometry, std::span<const Vec3> points_V_m, double margin_m);

/// The part of `volume` in `box`, with its axes, slope and intercept. An axis with voxels wider
/// than `spacing_m` is resampled to it by cubic convolution (Catmull–Rom), which passes through the
/// source's voxels; an axis that is as fine already is kept as it is. The first voxel is that of
/// the box; the last lies within the box. Beyond the volume the edge voxel repeats. Values that
/// overshoot what a count can hold are cut. Errors: bad_input (box empty or outside, spacing
/// outside 10 µm … 10 mm), too_large (kMaxResampledVoxels), cancelled.
core::Result<Volume> resample_finer(const Volume& volume, const Box& box, double spacing_m,
                                    const core::Progress& progress = {});

}  // namespace tractus::volume
