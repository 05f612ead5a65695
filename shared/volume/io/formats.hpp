/// The readers behind `read_volume`, one per format.
#pragma once

#include <filesystem>

#include "core/bytes.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus::volume_io {

/// Do these first bytes open a NIfTI-1 or -2 header?
bool looks_like_nifti(core::ByteView first);

core::Result<Imported> read_nifti(const std::filesystem::path& path,
                                  const core::Progress& progress);
core::Result<Imported> read_nrrd(const std::filesystem::path& path, const core::Progress& progress);
/// A folder of the slices of a series, one or several in each file, or one file of several. Cleaned
/// copies, one for each slice, lie in a scratch folder below the system's for temporary files while
/// they are read.
core::Result<Imported> read_dicom(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace tractus::volume_io
