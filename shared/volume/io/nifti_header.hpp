/// The header of a NIfTI file [NIfTI-1, nifti1.h; NIfTI-2, nifti2.h], read by ourselves so that its
/// claims are checked before VTK believes them.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// What of the header a CT needs. Geometry is LPS, metres.
struct NiftiHeader {
  volume::Geometry geometry;
  double scale = 1.0, offset = 0.0;  ///< CT value = offset + scale · stored
  int sample_bytes = 0;
  std::uint64_t data_at = 0;  ///< offset of the first voxel in the (inflated) file
  std::vector<std::string> notes;
};

/// Errors: bad_input naming the field and its byte.
core::Result<NiftiHeader> parse_nifti(core::ByteView first, const std::filesystem::path& path);

}  // namespace tractus::volume_io
