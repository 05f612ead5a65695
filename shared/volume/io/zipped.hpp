/// A zip of DICOM slices, or of one volume file, unpacked by names of our own.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace tractus::volume_io {

/// By its first bytes.
bool is_zip(const std::filesystem::path& path);

/// Writes the volume in a zip into `into` (made) and returns what `read_volume` takes: the folder of
/// the DICOM slices as 000001.dcm, 000002.dcm … in the archive's order, whatever folders they lay
/// in, or the one NIfTI, NRRD or .tvol file: names in the archive may name a patient. Other files
/// are passed over. Memory: one piece. Errors, without a name of the archive's: bad_input (damaged,
/// encrypted, no volume in it, more than one), too_large (over 4096 DICOM files or 16384 entries, over 4 GiB,
/// or over 64 MiB and 100 times the zip: no CT compresses so), io. What was unpacked by then stays
/// in `into`.
core::Result<std::filesystem::path> unpack_volume(const std::filesystem::path& zip,
                                                  const std::filesystem::path& into);

}  // namespace tractus::volume_io
