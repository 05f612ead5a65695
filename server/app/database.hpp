/// Which database a data folder's records are in.
#pragma once

#include <filesystem>
#include <string>

#include "db/store/store.hpp"

namespace tractus::app {

inline constexpr const char* kDatabase = "tractus.db";  ///< SQLite's file, unless it is elsewhere
/// In a folder whose records are in PostgreSQL: its address, without a password.
inline constexpr const char* kAddressFile = "database.address";
/// The environment's variable for the address; `--database` is the same, said aloud.
inline constexpr const char* kAddressVariable = "TRACTUS_DATABASE";

/// SQLite's file in the folder, or a PostgreSQL database.
struct Database {
  std::filesystem::path file;
  std::string address;  ///< empty: the file
  static Database file_in(const std::filesystem::path& folder) { return {folder / kDatabase, {}}; }
  bool is_shared() const { return !address.empty(); }
  /// For a person; never a password.
  std::string name() const;
  core::Result<store::Store> open() const;
};

/// That of a folder which has one: what the environment says (a folder of SQLite's then is an
/// error), else what is noted in the folder. Errors: not_found (no data folder), conflict,
/// bad_input.
core::Result<Database> database_of(const std::filesystem::path& folder);
/// That of a folder which is to be made. As above; without a word it is SQLite's.
core::Result<Database> new_database(const std::filesystem::path& folder);
/// Notes in the folder where its records are, when they are not in it.
core::Result<void> note_address(const std::filesystem::path& folder, const Database& database);

/// The number of the newest step that was applied; nothing is brought up to date.
core::Result<std::int64_t> schema_of(const Database& database);
/// For commands that leave the schema as it is: a server of the version before may be at work.
/// Errors: conflict when a step of this version is missing.
core::Result<void> check_up_to_date(const Database& database);

/// Takes an address from the command line, where anybody may read it. Errors: bad_input when it
/// holds a password.
core::Result<void> use_address(const std::string& address);

}  // namespace tractus::app
