/// Pictures of a volume for a web page: one plane of the patient, and the whole volume coarsely.
#pragma once

#include "server/api/cases/preview.hpp"
#include "volume/volume_file.hpp"

namespace tractus::api {

/// CT values from `low` to `high` become 0 … 255.
struct Window {
  double low, high;
};

enum class Plane { axial, coronal, sagittal };

/// A picture in radiological orientation: axial with the patient's left at the right and anterior
/// at the top, coronal with left at the right and superior at the top, sagittal with posterior at
/// the right and superior at the top.
struct SlicePicture {
  std::array<int, 2> dims{};                         ///< width, height
  double spacing_m = 0.0;                            ///< of pixels, square
  volume::Vec3 origin_m = volume::Vec3::Zero();      ///< LPS, centre of the first pixel
  volume::Vec3 along_row = volume::Vec3::Zero();     ///< LPS, towards growing columns
  volume::Vec3 along_column = volume::Vec3::Zero();  ///< LPS, towards growing rows
  std::string pixels;                                ///< [row][column], 0 outside the volume
};

/// Corners of the bounding box of the voxel centres along the patient's axes, LPS.
struct Bounds {
  volume::Vec3 low_m, high_m;
};
Bounds bounds_of(const volume::Geometry& geometry);

/// The plane at `at_m` along its normal (axial: z, coronal: y, sagittal: x), with linear
/// interpolation; no side has more than `max_side` pixels, and pixels are not finer than the
/// voxels. Reads only the necessary bricks. Errors: out_of_range if the plane does not cut the
/// volume; those of reading.
core::Result<SlicePicture> slice_picture(const volume::VolumeFile& file, Plane plane, double at_m,
                                         int max_side, const Window& window);

/// The whole volume as means over equal blocks of voxels, with at most `max_side` voxels along each
/// side; reads the volume slab by slab.
core::Result<Preview> whole_preview(const volume::VolumeFile& file, int max_side,
                                    const Window& window);

}  // namespace tractus::api
