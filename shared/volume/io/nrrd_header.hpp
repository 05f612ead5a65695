/// The header of a NRRD file [teem.sourceforge.net/nrrd/format.html], read by ourselves so that its
/// claims and the files it names are checked before teem believes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// What of the header a CT needs. Geometry is LPS, metres.
struct NrrdHeader {
  volume::Geometry geometry;
  int sample_bytes = 0;
  bool gzip = false;
  std::filesystem::path
      data;  ///< the file that holds the voxels: the header's own, or the one it names beside it
  std::uint64_t data_at = 0;  ///< offset of the voxels (of their gzip stream) in it
  std::vector<std::string> notes;
};

/// `text` is the start of the file, at least its header. Errors: bad_input naming line or field.
core::Result<NrrdHeader> parse_nrrd(std::string_view text, const std::filesystem::path& path);

}  // namespace tractus::volume_io
