/// Imports an uploaded volume: from the bytes of the upload to a volume among the objects.
#pragma once

#include "core/json.hpp"
#include "db/store/volumes/volumes.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

inline constexpr std::uint64_t kMaxVolume_bytes = 1ull << 30;

struct ImportedVolume {
  std::string sha256;
  std::uint64_t size_bytes = 0;
  core::Json facts, report;  ///< as jobs::import_volume answers
};

/// Reads and de-identifies the body of the call (Backend::import_volume; of several DICOM series
/// the one with the call's `series_uid`) in a temporary folder, and stores the volume among the
/// objects. Only one import runs at a time, because it needs the memory
/// of a volume. Errors: unavailable while another import runs; those of jobs::import_volume.
core::Result<ImportedVolume> take_in(const Call& call);
/// Whether to wait while another import runs.
enum class Turn { now, wait };
/// The same of a folder of DICOM files of one series, in `scratch`.
core::Result<ImportedVolume> take_in_series(const Backend& backend,
                                            const std::filesystem::path& series,
                                            const std::filesystem::path& scratch, Turn turn);

/// How a person names a volume, and who it is.
struct VolumeWish {
  std::string name, source;  ///< cut to the lengths that a record has
  std::string by, by_id;     ///< name and id of the account
};
/// Adds the record of an imported volume, which is held. Errors: conflict if its voxels are here.
core::Result<store::VolumeRecord> keep_volume(const Backend& backend, const ImportedVolume& taken,
                                              const VolumeWish& wish);

}  // namespace tractus::api
