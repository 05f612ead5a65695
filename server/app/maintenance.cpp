#include "server/app/maintenance.hpp"

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/database/copy.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/app/anchors.hpp"
#include "server/app/leaving.hpp"
#include "server/app/objects_address.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFormat = "tractus-backup/1";
constexpr std::uint64_t kMaxSmall_bytes = 64u << 20;

/// Keys, certificates and the trail's anchors: copied as they are, for their owner alone.
std::vector<std::string> small_files(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code failure;
  for (const char* name : {"secret.key", kHighWater, kAnchors, kErasureList})
    if (fs::exists(folder / name, failure)) out.emplace_back(name);
  for (const auto& entry : fs::directory_iterator(folder / kCertificates, failure))
    out.push_back(std::string(kCertificates) + "/" + entry.path().filename().string());
  return out;
}

core::Result<void> copy_small(const fs::path& from, const fs::path& to, const std::string& name) {
  auto bytes = TRY(core::read_file(from / name, kMaxSmall_bytes));
  std::error_code failure;
  fs::create_directories((to / name).parent_path(), failure);
  return core::write_file(to / name, bytes);
}

/// Those that are not in `to` yet.
core::Result<void> copy_small_files(const fs::path& from, const fs::path& to) {
  std::error_code failure;
  for (const std::string& name : small_files(from)) {
    if (fs::exists(to / name, failure)) continue;
    TRY(copy_small(from, to, name));
  }
  return {};
}

/// Objects that the database names, each checked against its name while it is copied.
core::Result<std::uint64_t> copy_objects(const fs::path& from, store::Store& names,
                                         const store::Objects& into, const core::Progress& shown) {
  const auto source = TRY(open_objects(from));
  auto entries = TRY(names.read([](store::Reading& tx) { return store::all_objects(tx); }));
  std::uint64_t bytes = 0, done = 0;
  for (const store::ObjectEntry& entry : entries) {
    if (auto in = into.copy_from(source, entry.sha256); !in)
      return core::Error{in.error().code,
                         fmt::format("object {}: {}", entry.sha256, in.error().what)};
    bytes += entry.size_bytes;
    if (!shown(double(++done) / double(entries.size())))
      return core::Error{core::Errc::cancelled, "stopped; nothing was written"};
  }
  return bytes;
}

/// What is here of unfinished uploads. One that ended meanwhile has no partial file: its station
/// hands it over again.
core::Result<void> copy_partials(const fs::path& from, store::Store& names,
                                 const store::PartialFiles& into) {
  auto source = TRY(store::PartialFiles::open(from));
  auto open = TRY(names.read([](store::Reading& tx) { return store::open_uploads(tx); }));
  for (const store::Upload& upload : open) {
    if (source.size_of(upload.trial_id) == 0) continue;
    auto bytes = core::read_file(source.path_of(upload.trial_id), 1u << 30);
    if (!bytes) continue;  // it ended just now
    TRY(into.append(upload.trial_id, 0, *bytes));
  }
  return {};
}

core::Result<core::Json> manifest_of(const fs::path& folder, store::Store& store,
                                     std::uint64_t object_bytes) {
  auto counts = TRY(store.read([](store::Reading& tx) -> core::Result<core::Json> {
    core::Json out = core::Json::object();
    for (const char* table : {"objects", "trials", "accounts", "audit"}) {
      auto rows = TRY(tx.query(std::string("select count(*) from ") + table));
      out[table] = rows.front().count(0);
    }
    return out;
  }));
  auto database = TRY(store::file_sha256(folder / kDatabase));
  core::Json files = core::Json::object();
  for (const std::string& name : small_files(folder)) {
    auto sha256 = TRY(store::file_sha256(folder / name));
    files[name] = sha256;
  }
  return core::Json{
      {"format", kFormat}, {"made_utc_us", core::utc_us()}, {"database_sha256", database},
      {"files", files},    {"object_bytes", object_bytes},  {"rows", counts}};
}

/// Objects and partial files beside a database that is in `to` already.
core::Result<std::uint64_t> copy_files(const fs::path& from, const fs::path& to,
                                       const core::Progress& shown) {
  auto names = TRY(store::Store::open(to / kDatabase));
  auto objects = TRY(open_objects(to));
  auto partials = TRY(store::PartialFiles::open(to));
  auto bytes = TRY(copy_objects(from, names, objects, shown));
  TRY(copy_partials(from, names, partials));
  TRY(copy_small_files(from, to));
  return bytes;
}

/// The records as they stand at one moment, in a SQLite file: a backup is read without a server.
core::Result<void> copy_records(const Database& source, const fs::path& file) {
  if (!source.is_shared()) return store::copy_database(source.file, file);
  auto from = TRY(source.open());
  auto to = TRY(store::Store::open(file));
  auto copied = from.read([&](store::Reading& reading) {
    return to.write([&](store::Writing& writing) { return store::copy_rows(reading, writing); });
  });
  if (!copied) return core::Error{copied.error().code, "backup: " + copied.error().what};
  return {};
}

/// The records of a restored folder into the database it shall have: all of them or none.
core::Result<void> move_records(const fs::path& folder, const Database& target) {
  {
    auto from = TRY(store::Store::open(folder / kDatabase));
    auto to = TRY(target.open());
    auto copied = from.read([&](store::Reading& reading) {
      return to.write([&](store::Writing& writing) { return store::copy_rows(reading, writing); });
    });
    if (!copied) return core::Error{copied.error().code, "restore: " + copied.error().what};
  }
  for (const char* rest : {"", "-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(folder / (std::string(kDatabase) + rest), ignored);
  }
  return note_address(folder, target);
}

core::Result<core::Json> read_manifest(const fs::path& from) {
  const fs::path path = from / kBackupManifest;
  auto json = core::read_json(path);
  if (!json) return json.error();
  if (!json->is_object() || json->value("format", "") != kFormat || !json->contains("files") ||
      !(*json)["files"].is_object())
    return core::Error{core::Errc::bad_input,
                       path.string() + ": is not a file of the format " + kFormat};
  return json;
}

core::Result<void> check_file(const fs::path& path, const core::Json& expected) {
  auto sha256 = TRY(store::file_sha256(path));
  if (expected.is_string() && sha256 == expected.get<std::string>()) return {};
  return core::Error{core::Errc::corrupt,
                     path.string() + ": the file differs from its SHA-256 in backup.json"};
}

/// Erases in the folder whom the lists name, of whom `outside` are not in the backup itself. Says so in the manifest.
core::Result<void> erase_again(const fs::path& folder, const fs::path& from,
                               const fs::path& erasures, core::Json& manifest) {
  std::vector<fs::path> lists{fs::absolute(from).lexically_normal().parent_path() / kErasureList};
  if (!fs::path(from).has_filename())  // "backups/ID/"
    lists.front() = lists.front().parent_path().parent_path() / kErasureList;
  std::error_code failure;
  std::erase_if(lists, [&](const fs::path& list) { return !fs::exists(list, failure); });
  if (!erasures.empty()) lists.push_back(erasures);
  const std::size_t outside = lists.size();
  if (fs::exists(from / kErasureList, failure)) lists.push_back(from / kErasureList);
  auto data = TRY(open_data(folder, Database::file_in(folder)));
  std::vector<store::Erasure> people;
  for (const fs::path& list : lists) {
    const auto more = TRY(read_erasure_list(list));
    people.insert(people.end(), more.begin(), more.end());
  }
  manifest["erased"] = TRY(apply_erasures(data, people));
  manifest["erasure_lists"] = outside;
  return {};
}

core::Result<core::ScratchFolder> scratch_for(const fs::path& target) {
  std::error_code failure;
  if (fs::exists(target, failure))
    return core::Error{core::Errc::conflict, target.string() + ": exists already"};
  return core::ScratchFolder::make(target);
}

}  // namespace

core::Result<core::Json> back_up(const fs::path& data, const fs::path& out,
                                 const core::Progress& shown) {
  auto source = TRY(database_of(data));
  TRY(check_up_to_date(source));  // else that version could not read the backup
  auto scratch = TRY(scratch_for(out));
  const fs::path& to = scratch.path();
  // Anchors before the records: what they note is in the records then.
  TRY(copy_small_files(data, to));
  TRY(copy_records(source, to / kDatabase));
  auto bytes = TRY(copy_files(data, to, shown));
  core::Json manifest;
  {
    auto store = TRY(store::Store::open(to / kDatabase));
    auto made = TRY(manifest_of(to, store, bytes));
    manifest = std::move(made);
  }
  // Closing folds the log into the database's file: its hash is that of the file as it lies there.
  auto database = TRY(store::file_sha256(to / kDatabase));
  manifest["database_sha256"] = database;
  TRY(core::write_json(to / kBackupManifest, manifest));
  TRY(scratch.keep_as(out));
  return manifest;
}

core::Result<core::Json> restore(const fs::path& from, const fs::path& data,
                                 const RestoreTarget& target, const core::Progress& shown,
                                 const fs::path& erasures) {
  auto manifest = TRY(read_manifest(from));
  TRY(check_file(from / kDatabase, manifest.value("database_sha256", core::Json())));
  for (const auto& [name, sha256] : manifest["files"].items()) {
    if (fs::path(name).is_absolute() || name.find("..") != std::string::npos)
      return core::Error{core::Errc::bad_input,
                         (from / kBackupManifest).string() + ": invalid file name " + name};
    TRY(check_file(from / name, sha256));
  }
  auto scratch = TRY(scratch_for(data));
  TRY(keep_objects_at(scratch.path(), target.objects_address));
  std::error_code failure;
  fs::copy_file(from / kDatabase, scratch.path() / kDatabase, failure);
  if (failure)
    return core::Error{core::Errc::io, fmt::format("{}: cannot copy: {}",
                                                   (from / kDatabase).string(), failure.message())};
  TRY(copy_files(from, scratch.path(), shown));
  TRY(erase_again(scratch.path(), from, erasures, manifest));
  if (target.records.is_shared()) TRY(move_records(scratch.path(), target.records));
  TRY(scratch.keep_as(data));
  return manifest;
}

}  // namespace app
}  // namespace tractus
