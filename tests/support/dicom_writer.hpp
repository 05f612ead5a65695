/// A DICOM series made from a volume, with a patient planted in it, so that reading and
/// de-identification have something to read and to find.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "volume/volume.hpp"

namespace tractus::test_support {

/// Every text planted: none may be found in what de-identification or import leaves.
inline const std::vector<std::string> kPlantedTexts = {
    "Mustermann^Erika",          "PID-4711-0815", "19470823",
    "Sanatorium Waldfrieden",    "Nurse^Ratched", "ACME private diary",
    "Mustermann^Erika^Referrer", "ACC-99-1234"};

struct DicomSeries {
  std::string transfer_syntax = "1.2.840.10008.1.2.1";  ///< of kTransferSyntaxes
  bool signed_pixels =
      false;  ///< CT values themselves in 16 bits, slope 1; else counts with slope and intercept
  double tilt_rad =
      0.0;  ///< gantry tilt: slice k is shifted along the columns by k · spacing · tan(tilt)
  double slope_drift = 0.0;  ///< added to the rescale slope from slice to slice
  std::string series_uid = "2.25.314159265358979";
  std::string prefix = "im";  ///< file names are prefix and a number that is not the slice's order
};

struct Syntax {
  const char* name;
  const char* uid;
};
/// Lossless transfer syntaxes that the writer makes (GDCM compresses).
inline constexpr Syntax kTransferSyntaxes[] = {
    {"implicit", "1.2.840.10008.1.2"},           {"explicit", "1.2.840.10008.1.2.1"},
    {"big_endian", "1.2.840.10008.1.2.2"},       {"rle", "1.2.840.10008.1.2.5"},
    {"jpeg_lossless", "1.2.840.10008.1.2.4.70"}, {"jpeg_ls", "1.2.840.10008.1.2.4.80"},
    {"jpeg_2000", "1.2.840.10008.1.2.4.90"}};

/// Writes a file per slice into `folder` (made when missing) and returns their names in slice
/// order. Attributes planted: patient's name, id, birth date, institution, operator, a private
/// group, and a nested sequence that repeats the name. A failure ends the test program.
std::vector<std::filesystem::path> write_dicom_series(const std::filesystem::path& folder,
                                                      const volume::Volume& volume,
                                                      const DicomSeries& series = {});

/// Writes an enhanced CT, one file of the volume's `slices` in that order as its frames, and returns
/// its path. Orientation, spacing and (without slope_drift) rescaling are shared by all frames, places
/// are each frame's. The attributes planted are those of a series, and the patient's name in each
/// frame's comments. `series.tilt_rad` and `prefix` are not used. A failure ends the test program.
std::filesystem::path write_enhanced_ct(const std::filesystem::path& path,
                                        const volume::Volume& volume,
                                        const std::vector<int>& slices,
                                        const DicomSeries& series = {});

}  // namespace tractus::test_support
