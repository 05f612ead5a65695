/// A server's folder: database, objects, partial files, keys.
#pragma once

#include <filesystem>

#include "core/json.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "server/api/people/secrets.hpp"
#include "server/app/database.hpp"

namespace tractus::app {

inline constexpr const char* kCertificates = "tls";  ///< http::certificate_files of this folder

struct DataFolder {
  std::filesystem::path path;
  store::Store store;
  store::Objects objects;
  store::PartialFiles partials;
  api::Secrets secrets;  ///< of its file secret.key, which no database holds
};

/// Opens one that `init` made, and brings its records to this version. Errors: not_found, and those of the database.
core::Result<DataFolder> open_data(const std::filesystem::path& path);
/// The same, but records of an earlier version stay as they are. Errors: also conflict (such
/// records).
core::Result<DataFolder> open_up_to_date(const std::filesystem::path& path);
/// With its records there, whatever the environment says.
core::Result<DataFolder> open_data(const std::filesystem::path& path, const Database& database);
/// Makes one, or opens what is there (accounts are another matter). @param objects_address  of
/// `keep_objects_at`; empty: objects are kept in the folder
core::Result<DataFolder> make_data(const std::filesystem::path& path,
                                   const std::string& objects_address);

/// core::make_private, with a line in the log when something was repaired.
core::Result<void> leave_to_owner(const std::filesystem::path& folder);

/// Removes what a process that died left half-made (*.part): in the folder, its objects, keys and
/// certificates. @param alone  no other server works there; else only what is older than a day goes
void remove_left_overs(const std::filesystem::path& folder, bool alone);

/// Makes a file of a new key, for its owner's eyes; one that is there stays. Errors: io.
core::Result<void> make_key_file(const std::filesystem::path& path);
/// Errors: not_found, io, corrupt (64 hexadecimal characters are expected).
core::Result<api::Secrets::Key> read_key_file(const std::filesystem::path& path);

/// An act of the command line, by the user of this system who typed it.
store::AuditedAction command_act(const std::string& command, const core::Json& detail);

/// Held while a process serves a folder; the system lets go of it when the process ends, however it
/// ends.
class ServingLock {
 public:
  /// One process alone, or, when the folder's records are in a shared database, one of several.
  /// Errors: conflict when another process serves the folder by itself.
  static core::Result<ServingLock> take(const std::filesystem::path& data, bool shared);
  ~ServingLock();
  ServingLock(ServingLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  ServingLock& operator=(ServingLock&&) = delete;

 private:
  explicit ServingLock(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace tractus::app
