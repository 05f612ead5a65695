/// A frozen cohort: a tidy CSV, its dictionary and its hash, so that an analysis is of these data
/// and no others.
///
/// A folder of data.csv and snapshot.json:
///
///     {"format":"tractus-snapshot/1","name":"…","frozen_utc":"…","simulated":false,"source":"…",
///      "file":"data.csv","sha256":"…","rows":120,
///      "dictionary":[{"name":"force_N","kind":"number","unit":"N","meaning":"…","missing":0,
///                     "lowest":1,"highest":9},
///                    {"name":"scenario","kind":"text","levels":["hard","soft"],"missing":0}]}
#pragma once

#include <filesystem>
#include <map>

#include "assessment/table.hpp"
#include "core/json.hpp"

namespace tractus::assessment {

struct Snapshot {
  core::Json description;  ///< snapshot.json
  core::Bytes data;        ///< data.csv
  Table table;             ///< all columns, empty cells kept

  /// Reads and checks a folder. Errors: not_found, io, bad_input, conflict when data.csv is not
  /// what was frozen.
  static core::Result<Snapshot> read(const std::filesystem::path& folder);
  const std::string& sha256() const { return description["sha256"].get_ref<const std::string&>(); }
};

/// What a snapshot is told beside its data.
struct Freezing {
  std::string name, utc, source;
  bool simulated = false;
  std::map<std::string, std::string> meanings;  ///< by column
};

/// Errors: as Table::parse; bad_input for the meaning of a column that is not there.
core::Result<Snapshot> frozen(core::Bytes data, const Freezing& by);
/// Writes the folder, whole or not at all. Errors: io, conflict when it is there.
core::Result<void> write(const Snapshot& snapshot, const std::filesystem::path& folder);

/// The table as CSV with a last column "excluded_because": per row, why a plan leaves it out.
std::string marked(const Table& table, const std::vector<std::string>& excluded_because);
/// The dictionary of that, from snapshot.json.
core::Json dictionary_of_marked(const core::Json& description);

/// The unit that a column's name ends in: "N" of force_N, "m/s" of velocity_m_s; empty if none.
std::string unit_of(const std::string& column);

}  // namespace tractus::assessment
