/// One DICOM file's tags, through GDCM.
#pragma once

#include "volume/io/dicom_slices.hpp"

namespace tractus::volume_io {

/// Checks the file's structure and reads what a slice needs. Errors: bad_input naming the file and
/// the attribute.
core::Result<Slice> read_slice_tags(const std::filesystem::path& path);

/// Does the file open as DICOM does?
bool is_dicom_file(const std::filesystem::path& path);

inline constexpr std::uint64_t kSliceLimitBytes = 256ull << 20;  ///< of one file

}  // namespace tractus::volume_io
