/// Backup of a data folder while the server runs, and checks of a data folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "db/store/operations/audit.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::store {

/// Copies the database as it is at one moment, while other connections may write. Errors: io;
/// conflict if `copy` exists.
core::Result<void> copy_database(const std::filesystem::path& database,
                                 const std::filesystem::path& copy);

struct ObjectEntry {
  std::string sha256;
  std::uint64_t size_bytes = 0;
};
core::Result<std::vector<ObjectEntry>> all_objects(Reading& tx);

/// Errors that the check found, one line each; empty if there are none.
struct Findings {
  std::vector<std::string> lines;
  std::uint64_t objects = 0, bytes = 0;
  ChainEnd audit;
  std::int64_t covered_since_utc_us =
      0;  ///< rows are compared with the audit trail; 0: they are not
  std::size_t covered_tables = 0;
};

/// Ends of the audit trail that are stored outside the database: number and hash.
using Anchors = std::vector<ChainEnd>;

/// Everything that can be checked: the database's own structure and references, every object
/// against its name, the audit trail against its key and against the anchors, the rows of the
/// covered tables (coverage.hpp) against the audit trail. `shown(share)` may return false to stop.
/// Errors: those of reading; cancelled.
core::Result<Findings> look_over(Store& store, const Objects& objects, const AuditKey& key,
                                 const Anchors& anchors,
                                 const std::function<bool(double)>& shown = {});

}  // namespace tractus::store
