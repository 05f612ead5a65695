/// Backup, restore, looking over: what keeps a data folder through years.
#pragma once

#include "core/progress.hpp"
#include "db/store/operations/backup.hpp"
#include "server/app/data_folder.hpp"

namespace tractus::app {

inline constexpr const char* kBackupManifest = "backup.json";  ///< in every backup's folder

/// Copies a folder, served or not, to a new folder `out`: the records as they stand at one moment
/// (those of a PostgreSQL database too, as a SQLite file, so that a backup is whole by itself),
/// every object it names (checked on the way), what of unfinished uploads is acknowledged, keys and
/// certificates, and backup.json with what is in it. `out` appears whole or not at all.
/// Errors: conflict (`out` exists; records of an earlier version), corrupt (an object is not what its name says), io, cancelled.
core::Result<core::Json> back_up(const std::filesystem::path& data,
                                 const std::filesystem::path& out, const core::Progress& shown);

/// Where what a backup holds goes.
struct RestoreTarget {
  Database records;             ///< PostgreSQL's, which must be empty, or the folder's own file
  std::string objects_address;  ///< of `keep_objects_at`; empty: into the folder
};

/// Makes a new data folder of a backup, every file checked against backup.json and its name. Its
/// records and objects go into `target`: so a server moves from a file and a folder to PostgreSQL and
/// an object store, or back. People who were erased since the backup was made are
/// erased in the new folder before it appears: those of the list in the backup, of the list beside
/// the backup's folder, and of `erasures` (leaving.hpp). "erased" in the answer counts them, and
/// "erasure_lists" is how many lists there were outside the backup.
/// Errors: as above; bad_input when `from` is no backup.
core::Result<core::Json> restore(const std::filesystem::path& from,
                                 const std::filesystem::path& data, const RestoreTarget& target,
                                 const core::Progress& shown,
                                 const std::filesystem::path& erasures = {});

}  // namespace tractus::app
