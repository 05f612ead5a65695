#include "server/api/volumes/volume_intake.hpp"

#include <mutex>

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "server/api/backend.hpp"
#include "server/jobs/import_volume.hpp"

namespace tractus {
namespace api {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::size_t kMaxVolumeName = 200, kMaxSource = 1000;

Result<ImportedVolume> kept(const Backend& backend, const fs::path& folder, core::Json answer) {
  const fs::path file = folder / jobs::kTakenVolume;
  auto sha256 = TRY(store::file_sha256(file));
  TRY(backend.objects.copy_in(file, sha256));
  std::error_code failure;
  return ImportedVolume{sha256, fs::file_size(file, failure), std::move(answer["facts"]),
                        std::move(answer["report"])};
}

/// To be held while a volume is read.
Result<std::unique_lock<std::mutex>> turn_to_import(Turn turn) {
  static std::mutex one_at_a_time;
  std::unique_lock held(one_at_a_time, std::defer_lock);
  if (turn == Turn::wait) held.lock();
  if (turn == Turn::now && !held.try_lock())
    return Error{Errc::unavailable, "another volume is being read: try again in a minute"};
  return held;
}

/// @pre it is this import's turn
Result<ImportedVolume> imported(const Backend& backend, const fs::path& upload,
                                const fs::path& folder, const std::string& series_uid = "") {
  const volume_io::UidKey key = backend.secrets.uid_key();
  auto answer = TRY(backend.import_volume ? backend.import_volume(upload, folder, key, series_uid)
                                          : jobs::import_volume(upload, folder, key, series_uid));
  return kept(backend, folder, std::move(answer));
}

}  // namespace

Result<ImportedVolume> take_in(const Call& call) {
  const std::string& series_uid = call.text("series_uid");
  if (series_uid.size() > 64 || series_uid.find_first_not_of("0123456789.") != std::string::npos)
    return core::bad_input("series_uid: digits and dots are expected, at most 64");
  const auto held = TRY(turn_to_import(Turn::now));
  // On the data's disk: what a server that dies in the midst leaves there, the next start removes.
  auto scratch = TRY(core::ScratchFolder::make(call.backend.scratch->folder() / "volume"));
  const auto upload = TRY(body_in(call, scratch.path(), "upload"));
  return imported(call.backend, upload, scratch.path(), series_uid);
}

Result<ImportedVolume> take_in_series(const Backend& backend, const fs::path& series,
                                      const fs::path& scratch, Turn turn) {
  const auto held = TRY(turn_to_import(turn));
  return imported(backend, series, scratch);
}

Result<store::VolumeRecord> keep_volume(const Backend& backend, const ImportedVolume& taken,
                                        const VolumeWish& wish) {
  store::VolumeRecord v;
  v.id = core::new_id();
  v.name = wish.name.substr(0, kMaxVolumeName);
  v.source = wish.source.substr(0, kMaxSource);
  v.sha256 = taken.sha256;
  v.size_bytes = taken.size_bytes;
  v.facts = taken.facts.dump();
  v.report = taken.report.dump();
  v.made_utc_us = backend.now_utc_us();
  v.made_by = wish.by;
  v.made_by_id = wish.by_id;
  TRY(backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::add_object(tx, v.sha256, v.size_bytes, v.made_utc_us));
    return store::add_volume(tx, v);
  }));
  return v;
}

}  // namespace api
}  // namespace tractus
