/// The series of a folder, told apart before one of them is read.
#pragma once

#include "volume/io/dicom_slices.hpp"

namespace tractus::volume_io {

/// The files of one series: of the folder's only one, or of the one with the Series Instance UID
/// `series_uid` (empty: none is chosen). `from` (a folder, or one file) is named in errors.
/// Errors: bad_input in one line that lists the series if there are several and none is chosen, or
/// if none has that UID: of each its UID, number, modality, slices, spacings, thickness and kernel
/// where these are of the standard's form; no description, in which a name may stand. Those of
/// parse_dicom_layout for a file that does not say of which series it is.
core::Result<Listing> chosen_series(const Listing& listing, const std::string& series_uid,
                                    const std::filesystem::path& from);

}  // namespace tractus::volume_io
