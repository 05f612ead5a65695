/// A zip of DICOM slices, unpacked by names of our own.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace tractus::volume_io {

/// By its first bytes.
bool is_zip(const std::filesystem::path& path);

/// Writes the DICOM files of a zip into `into` (made), whatever folders they lay in, as
/// 000001.dcm, 000002.dcm … in the archive's order: names in it may name a patient. Other files are
/// passed over. Memory: one piece. Errors, without a name of the archive's: bad_input (damaged,
/// encrypted, no DICOM file in it), too_large (over 4096 DICOM files or 16384 entries, over 4 GiB,
/// or over 64 MiB and 100 times the zip: no CT compresses so), io. What was unpacked by then stays
/// in `into`.
core::Result<void> unpack_slices(const std::filesystem::path& zip,
                                 const std::filesystem::path& into);

}  // namespace tractus::volume_io
