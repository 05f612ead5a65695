/// The schema's steps, db/migrations/NNNN_name.sql, as they were when this program was built.
#pragma once

#include <string>
#include <vector>

#include "db/store/database/connection.hpp"

namespace tractus::store {

struct Migration {
  std::int64_t version;  ///< NNNN, from 1
  std::string name;
  std::string sql;
};

/// In order of version.
std::vector<Migration> migrations();

/// Brings the database to the last of `steps`, all missing steps in one transaction: a step that
/// fails leaves the database as it was. On PostgreSQL it gives way to who uses the tables, and tries
/// for a minute. Errors: conflict when the database is newer than the steps
/// (a newer program made it); those of the connection.
core::Result<void> migrate(Connection& connection, const std::vector<Migration>& steps);
/// Runs the missing steps and rolls them back; returns which they were. The same errors.
core::Result<std::vector<Migration>> try_migrations(Connection& connection,
                                                    const std::vector<Migration>& steps);

}  // namespace tractus::store
