/// How a DICOM file is built, walked by ourselves so that no library is asked to take memory for a
/// length that lies.
#pragma once

#include <filesystem>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace volume_io {

/// Where the pixels of a file lie. PS3.5 section 7.1 (elements), 7.5 (sequences), A.4 (fragments).
struct DicomLayout {
  std::string transfer_syntax;
  bool compressed = false;  ///< pixels are in fragments
  std::size_t pixels_at =
      0;  ///< offset of the pixel bytes, or of the first fragment that holds any; 0: no pixels
  std::size_t pixel_bytes = 0;
};

/// Has it the preamble and "DICM" of PS3.10?
bool looks_like_dicom(core::ByteView file);

/// Walks every element and sequence and holds each length against what is left of the file.
/// Errors: bad_input naming the element, its offset and the length it claims; a transfer syntax we
/// do not read.
core::Result<DicomLayout> parse_dicom_layout(core::ByteView file,
                                             const std::filesystem::path& path);

/// Rows and columns that a JPEG, JPEG-LS or JPEG 2000 stream states of itself; {0, 0} when it is
/// none of these.
std::pair<std::uint32_t, std::uint32_t> codestream_extent(core::ByteView stream);

}  // namespace volume_io
