/// CT volumes from other people's files: NIfTI, NRRD and DICOM series, made ours at this edge.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/progress.hpp"
#include "core/result.hpp"
#include "volume/io/uid_key.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// A volume read, and what a person should know of how.
struct Imported {
  volume::Volume volume;
  std::string format;  ///< "NIfTI", "NRRD", "DICOM" or "tractus-volume/1"
  std::string source;  ///< name of the file or folder, without its path
  std::vector<std::string>
      notes;  ///< one line each: assumptions made and losses taken, empty when there were none
  std::string modality = {};                 ///< of DICOM: "CT", "MR" …; else empty
  std::vector<std::string> suspicions = {};  ///< of text or a face in the pixels, one line each
  core::Json report = core::Json::object();  ///< what became of a file's attributes, no values
};

struct ReadOptions {
  UidKey uid_key{};  ///< for the identifiers of a DICOM series
  core::Progress progress = {};
  /// Series Instance UID of the DICOM series to read; empty: the only one of the folder.
  std::string series_uid = {};
};

/// Reads a NIfTI (.nii, .nii.gz), NRRD (.nrrd, .nhdr with its data beside it), DICOM series (a
/// folder of one series) or .tvol. The kind is told by content. Geometry is kept, in LPS and
/// metres; values are kept exactly where they are whole numbers over a range of at most 65535, and
/// else in 65536 levels, with a note saying so. The file's claims are checked against its size
/// before any library sees it, and before memory is taken for them. A DICOM series is de-identified
/// first (deidentify.hpp); of the others nothing but geometry, scaling and voxels is read. A folder
/// of several series is refused with a list of them, unless one is chosen. Errors:
/// not_found, io, bad_input (one line: file, place, what is wrong, what is expected), too_large,
/// cancelled.
core::Result<Imported> read_volume(const std::filesystem::path& path,
                                   const ReadOptions& options = {});
core::Result<Imported> read_volume(const std::filesystem::path& path,
                                   const core::Progress& progress);

}  // namespace tractus::volume_io
