#include "volume/io/read_volume.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_tags.hpp"
#include "volume/io/formats.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLookAtBytes = 540;  // the longest of the formats' fixed headers, NIfTI-2's

core::Result<Imported> read_own(const fs::path& path, const core::Progress& progress) {
  auto file = TRY(volume::VolumeFile::open(path));
  auto whole = TRY(file.read_all(progress));
  Imported out{std::move(whole), "tractus-volume/1", file.meta().source, {}};
  if (!file.meta().note.empty()) out.notes.push_back(file.meta().note);
  return out;
}

}  // namespace

core::Result<Imported> read_volume(const fs::path& path, const core::Progress& progress) {
  return read_volume(path, ReadOptions{.progress = progress});
}

core::Result<Imported> read_volume(const fs::path& path, const ReadOptions& options) {
  const core::Progress& progress = options.progress;
  std::error_code failure;
  if (fs::is_directory(path, failure) || is_dicom_file(path)) return read_dicom(path, options);
  if (!options.series_uid.empty())
    return bad(path, "a series is chosen from a folder or a zip of DICOM files, which this is not");
  const auto first = TRY(first_bytes(path, kLookAtBytes));
  const std::string_view text = core::text_of(first);
  if (text.starts_with("TRACTVOL")) return read_own(path, progress);
  if (text.starts_with("NRRD000")) return read_nrrd(path, progress);
  if (looks_like_nifti(first)) return read_nifti(path, progress);
  return bad(path, fmt::format("starts with \"{}\", which is no NIfTI, NRRD, DICOM or .tvol file",
                               printable(std::string(text.substr(0, 16)))));
}

}  // namespace volume_io
}  // namespace tractus
