/// The scored trials of a cohort as one tidy table, and what its columns mean.
#pragma once

#include <map>

#include "db/store/cohort/released.hpp"

namespace tractus::jobs {

/// One row per trial that counts and is scored, oldest first. Columns: trial and participant (the
/// pseudonyms of every export), study, number (of the trial among the participant's in the study,
/// from 1), running_number (among all of the participant's in the table, from 1), cohort, level,
/// experience_years, date and year (the day as "2026-07-02" and as 2026.4986), case, rig,
/// simulated, correct (1, 0), then each metric that any row has, by its id. What is not known is an
/// empty cell.
struct CohortTable {
  std::string csv;  ///< with a header line, LF
  std::string sha256;
  std::size_t rows = 0, simulated = 0;
  // Trials left out:
  std::size_t invalid = 0;   ///< a person said so, their place had one already, or cut short
  std::size_t unscored = 0;  ///< not assessed yet, or it failed
  std::size_t without_consent = 0;
  std::size_t blind = 0;  ///< of a study, and the participant still has trials to do
  std::map<std::string, std::string> meanings;  ///< by column, with the unit
};

CohortTable cohort_table(const store::ReleasedTrials& released);

}  // namespace tractus::jobs
