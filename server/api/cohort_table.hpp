/// The scored trials of a cohort as one tidy table, and a statistical method run on it.
#pragma once

#include "server/api/backend.hpp"

namespace api {

/// One row per trial that counts and is scored, oldest first. Columns: trial, participant (a
/// study's pseudonym, else the operator's name), study, number (of the trial among the
/// participant's, from 1), level, experience_years, case, rig, simulated, correct (1, 0), then each
/// metric that any row has, by its id. What is not known is an empty cell.
struct CohortTable {
  std::string csv;  ///< with a header line, LF
  std::string sha256;
  std::size_t rows = 0, simulated = 0;
  // Trials left out:
  std::size_t invalid = 0;   ///< a person said so, their place had one already, or cut short
  std::size_t unscored = 0;  ///< not assessed yet, or it failed
};

/// @param study  its trials alone; empty: all. Errors: bad_input for a study there is not;
/// too_large
///   for more than 20 000 trials.
core::Result<CohortTable> cohort_table(Backend& backend, const std::string& study);

/// {"method", "formula"?, "options"?, "study"?} → {"method", "formula", "study", "rows",
/// "rows_simulated", "left_out", "sha256", "report"}. Errors: bad_input naming the field.
core::Result<core::Json> cohort_analysis(Backend& backend, const core::Json& asked);

}  // namespace api
