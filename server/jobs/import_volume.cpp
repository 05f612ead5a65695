#include "server/jobs/import_volume.hpp"

#include "core/try.hpp"
#include "volume/io/burnt_text.hpp"
#include "volume/io/read_volume.hpp"
#include "volume/io/zipped.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace jobs {
namespace {

namespace fs = std::filesystem;
using core::Json;
using core::Result;

constexpr const char* kUnpacked = "unpacked";  // within the folder: what a zip holds

std::vector<double> numbers(const volume::Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json facts_of(const volume_io::Imported& in) {
  const volume::Geometry& g = in.volume.geometry;
  std::vector<double> directions;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) directions.push_back(g.directions(row, column));
  std::vector<std::string> suspicions = in.suspicions;
  for (auto& found : volume_io::text_suspicions(in.volume)) suspicions.push_back(std::move(found));
  return {{"format", in.format},
          {"modality", in.modality.empty() ? Json() : Json(in.modality)},
          {"dims", g.dims},
          {"spacing_m", numbers(g.spacing_m)},
          {"origin_m", numbers(g.origin_m)},
          {"directions", directions},
          {"range", volume::value_range_of(in.volume)},
          {"notes", in.notes},
          {"suspicions", suspicions}};
}

std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const auto& line : lines) out += (out.empty() ? "" : "; ") + line;
  return out;
}

/// Paths of this machine are nobody's business: messages begin with "the upload".
core::Error without_path(core::Error error, const fs::path& folder, const fs::path& upload) {
  for (const std::string& path : {upload.string(), (folder / kUnpacked).string(), folder.string()})
    for (std::size_t at; (at = error.what.find(path)) != std::string::npos;)
      error.what.replace(at, path.size(), "the upload");
  return error;
}

Result<volume_io::Imported> read(const fs::path& upload, const fs::path& folder,
                                 const volume_io::ReadOptions& options) {
  if (!volume_io::is_zip(upload)) return volume_io::read_volume(upload, options);
  const fs::path volume = TRY(volume_io::unpack_volume(upload, folder / kUnpacked));
  return volume_io::read_volume(volume, options);
}

}  // namespace

Result<Json> import_volume(const fs::path& upload, const fs::path& folder,
                           const volume_io::UidKey& key, const std::string& series_uid) {
  auto in = read(upload, folder, {.uid_key = key, .series_uid = series_uid});
  if (!in) return without_path(in.error(), folder, upload);
  // A note within a .tvol may be anybody's words.
  if (in->format == "tractus-volume/1") in->notes.clear();
  const auto written = volume::write_volume(folder / kTakenVolume, in->volume,
                                            {in->format + " volume", joined(in->notes)});
  if (!written) return without_path(written.error(), folder, upload);
  return Json{{"facts", facts_of(*in)}, {"report", in->report}};
}

}  // namespace jobs
}  // namespace tractus
