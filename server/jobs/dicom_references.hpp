/// Which instances DICOM files are, for who sent them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::jobs {

/// By its two identifiers (PS3.3, table C.12-1). They are the patient's: they go back to whoever
/// sent the file, and are not kept.
struct InstanceReference {
  std::string class_uid, instance_uid;
};
/// Of the files of a folder, by name. Errors: those of reading; bad_input for a file that is no
/// DICOM or has no such identifiers.
core::Result<std::vector<InstanceReference>> instances_in(const std::filesystem::path& folder);

}  // namespace tractus::jobs
