/// A CT volume as NRRD [teem.sourceforge.net/nrrd/format.html], for 3D Slicer and other programs.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// Writes CT values with their geometry in LPS and millimetres, compressed: 16-bit whole numbers
/// where all values are such, else 32-bit floating point. Not atomic: write into a folder that is
/// renamed when whole. Errors: io.
core::Result<void> write_nrrd(const std::filesystem::path& path, const volume::Volume& volume);

}  // namespace tractus::volume_io
