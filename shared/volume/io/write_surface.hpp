/// Surfaces of a volume as binary STL, for 3D Slicer, printers and other programs: LPS, millimetres.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "volume/tract.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// The surface on which the CT value is `value` (flying edges), normals towards lower values. Not
/// atomic: write into a folder that is renamed when whole. Returns the number of triangles. Errors:
/// out_of_range (no voxel, or every voxel, lies above `value`), io.
core::Result<std::size_t> write_bone_stl(const std::filesystem::path& path,
                                         const volume::Volume& volume, double value);

/// The tract as a closed cylinder of its radius from mouth to end, 48 sides. Errors: io.
core::Result<void> write_tract_stl(const std::filesystem::path& path, const volume::Tract& tract);

}  // namespace tractus::volume_io
