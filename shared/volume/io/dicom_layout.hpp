/// How a DICOM file is built, walked by ourselves so that no library is asked to take memory for a
/// length that lies.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::volume_io {

/// Where the pixels of a file lie. PS3.5 section 7.1 (elements), 7.5 (sequences), A.4 (fragments).
struct DicomLayout {
  std::string transfer_syntax;
  bool with_vr = true;      ///< explicit syntax
  bool big_endian = false;  ///< of the data set; the meta information never is
  bool compressed = false;  ///< pixels are in fragments
  std::size_t pixels_at =
      0;  ///< offset of the pixel bytes, or of the first fragment that holds any; 0: no pixels
  std::size_t pixel_bytes = 0;
};

/// An element as it lies in the file. Fragments of pixels are within their element.
struct DicomElement {
  std::uint32_t tag = 0;     ///< 0xGGGGEEEE
  std::string_view vr;       ///< empty in implicit syntaxes
  std::size_t at = 0;        ///< of its header
  std::size_t value_at = 0;  ///< of its value, or of its first item
  std::size_t end = 0;       ///< one beyond it, closing items included
  int depth = 0;             ///< 0: of the data set itself; -1: of the file's meta information
  std::size_t item_at = 0;   ///< of the sequence's item that holds it; 0 at depth 0
};
using ElementSeen = std::function<void(const DicomElement&)>;

/// Has it the preamble and "DICM" of PS3.10?
bool looks_like_dicom(core::ByteView file);

/// A file's meta information (PS3.10 section 7.1), which no transfer syntax deflates.
struct DicomMeta {
  std::string transfer_syntax;
  std::size_t end = 0;  ///< offset at which the data set begins
};
/// Errors: bad_input naming the element and the length it claims.
core::Result<DicomMeta> parse_dicom_meta(core::ByteView file, const std::filesystem::path& path);

/// Walks every element and sequence and holds each length against what is left of the file.
/// Errors: bad_input naming the element, its offset and the length it claims; a transfer syntax we
/// do not read.
/// `seen` (if given) gets every element, nested ones before the one that holds them.
core::Result<DicomLayout> parse_dicom_layout(core::ByteView file, const std::filesystem::path& path,
                                             const ElementSeen& seen = {});

/// Rows and columns that a JPEG, JPEG-LS or JPEG 2000 stream states of itself; {0, 0} when it is
/// none of these.
std::pair<std::uint32_t, std::uint32_t> codestream_extent(core::ByteView stream);

}  // namespace tractus::volume_io
