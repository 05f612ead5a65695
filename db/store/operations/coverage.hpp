/// Which rows the audit trail covers, and their digests.
///
/// A transaction that changes rows of a covered table adds a digest of each such row, as it is
/// after the change, to the audit trail's row of that transaction. Whoever edits, deletes or
/// inserts a row by other means leaves a row whose digest is not the newest one in the trail.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "db/store/operations/audit.hpp"

namespace tractus::store {

/// A digest is that of all rows with the same key.
struct CoveredTable {
  std::string name;
  std::vector<std::string> keys;
  std::vector<std::string> columns;  ///< the others that the digest covers
};

/// The covered tables: those on which assessment and access depend.
const std::vector<CoveredTable>& covered_tables();
/// The covered table that a statement changes (insert into, update, delete from), or null.
const CoveredTable* changed_table(std::string_view sql);
/// The statement, with the keys of the rows that it changed as its last columns.
std::string returning_keys(std::string_view sql, const CoveredTable& table);

/// Digests of the keys' rows as they are now, as the JSON that goes into the trail; "" when nothing
/// has changed.
core::Result<std::string> changes_text(Reading& tx, const AuditKey& key, const ChangedRows& rows);

/// Begins to cover the existing rows: writes their digests into the trail, once, and again if a new
/// program version covers other tables. Returns whether it wrote digests. Rows that differ from the
/// trail at that time are counted in the trail and remain a finding.
core::Result<bool> begin_coverage(Store& store);

/// The newest digests of the trail. Call add() with every row of the trail in order, then
/// compare().
class TrailDigests {
 public:
  void add(const AuditRow& row);
  /// Adds a line for every covered row that differs from its digest in the trail.
  core::Result<void> compare(Reading& tx, const AuditKey& key, std::vector<std::string>& findings);
  /// Time since which rows are covered, in microseconds since 1970-01-01 UTC; 0: rows are not
  /// covered.
  std::int64_t since_utc_us() const { return since_utc_us_; }
  std::size_t tables() const { return tables_.size(); }

 private:
  void begin(const AuditRow& row);
  std::int64_t since_utc_us_ = 0;
  std::vector<CoveredTable> tables_;
  std::map<std::string, std::map<std::string, std::string>> digests_;  ///< by table and key
  std::vector<std::string> found_;                                     ///< in the trail itself
};

}  // namespace tractus::store
