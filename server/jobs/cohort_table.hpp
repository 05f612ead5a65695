/// The scored trials of a cohort as one tidy table, and what its columns mean.
#pragma once

#include <map>

#include "db/store/store.hpp"

namespace jobs {

/// One row per trial that counts and is scored, oldest first. Columns: trial, participant (a
/// study's pseudonym, else one made of the operator's name by the server's key: never the name),
/// study, number (of the trial among the participant's, from 1), level, experience_years, case,
/// rig, simulated, correct (1, 0), then each metric that any row has, by its id. What is not known
/// is an empty cell.
struct CohortTable {
  std::string csv;  ///< with a header line, LF
  std::string sha256;
  std::size_t rows = 0, simulated = 0;
  // Trials left out:
  std::size_t invalid = 0;   ///< a person said so, their place had one already, or cut short
  std::size_t unscored = 0;  ///< not assessed yet, or it failed
  std::map<std::string, std::string> meanings;  ///< by column, with the unit
};

/// @param study  its trials alone; empty: all.  @param most  more trials are too many.
/// Errors: bad_input for a study there is not; too_large.
core::Result<CohortTable> cohort_table(store::Store& store, const std::string& study,
                                       std::int64_t most);

}  // namespace jobs
