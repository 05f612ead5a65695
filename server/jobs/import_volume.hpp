/// Somebody's CT becomes ours, without the patient.
#pragma once

#include <filesystem>

#include "core/json.hpp"
#include "core/result.hpp"
#include "volume/io/uid_key.hpp"

namespace tractus::jobs {

inline constexpr const char* kTakenVolume = "volume.tvol";

/// Reads `upload` (a zip or a folder of DICOM files, or a NIfTI, NRRD or .tvol file; told by
/// content), de-identifies it and writes `folder`/volume.tvol. `series_uid` chooses one of several
/// DICOM series. What is kept of it beside the voxels
/// is the answer: {"facts":{"format","modality"|null,"dims","spacing_m","origin_m","directions"
/// (row-major), "range":[low,high],"notes":[…],"suspicions":[…]},"report":
/// tractus-deidentification/1}. No text of the file and no name of one is in it. Scratch files lie
/// in `folder`. Errors: bad_input, too_large: one line, without a value of the file;
/// but where a series must be chosen, it lists those that there are (volume_io::chosen_series).
core::Result<core::Json> import_volume(const std::filesystem::path& upload,
                                       const std::filesystem::path& folder,
                                       const volume_io::UidKey& key,
                                       const std::string& series_uid = "");

}  // namespace tractus::jobs
