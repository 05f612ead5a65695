/// The slices of a DICOM series: what each says of itself, and whether together they make a volume.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume_io {

/// One file of a series.
struct Slice {
  std::filesystem::path path;
  std::string series, modality, transfer_syntax;
  int rows = 0, columns = 0, bits = 0;
  bool is_signed = false;
  volume::Vec3 position_m = volume::Vec3::Zero();  ///< centre of the first pixel, LPS
  volume::Vec3 along_row = volume::Vec3::Zero();   ///< unit vector towards growing columns, LPS
  volume::Vec3 along_column = volume::Vec3::Zero();
  double row_step_m = 0.0,
         column_step_m = 0.0;  ///< between neighbours along the row, along the column
  double slope = 1.0, intercept = 0.0;
};

/// A folder's slices in order, and where their voxels lie.
struct Series {
  std::vector<Slice> slices;  ///< sorted along the normal, row × column
  volume::Geometry geometry;
  double tilt_rad = 0.0;  ///< angle between the slices' normal and the way they are stacked
  volume::Vec3 shear_m =
      volume::Vec3::Zero();  ///< shift within the plane from slice to slice, when tilted
  bool same_scaling = true;
  std::vector<std::string> notes;
};

inline constexpr std::size_t kMostSlices = 4096;  ///< of a series
core::Error too_many_slices(const std::filesystem::path& path);

/// The files of a folder, not of folders in it.
struct Listing {
  std::vector<std::filesystem::path> files;  ///< DICOM, sorted by name
  std::size_t others = 0;                    ///< files that are no DICOM
  std::size_t other_series = 0;              ///< DICOM files of series that are not read
};
/// Errors: bad_input when none is DICOM, io, too_large (over 4096).
core::Result<Listing> list_series(const std::filesystem::path& folder);

/// Reads the tags of every DICOM file of a folder (not of folders in it) and checks that they are
/// the slices of one volume: one series, one size, one orientation, evenly spaced, none missing,
/// none twice. Errors: not_found, io, bad_input naming the files that do not fit, too_large,
/// cancelled.
core::Result<Series> scan_series(const std::filesystem::path& folder,
                                 const core::Progress& progress);

}  // namespace tractus::volume_io
