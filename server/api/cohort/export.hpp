/// Exports for research: tidy tables with one row per item, and signals as arrays, only of released
/// trials (db/store/cohort/released.hpp).
#pragma once

#include "db/store/cohort/released.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// The trials of a study (empty: all trials) whose consent tier is at least `least`. Errors: those
/// of store::ReleasedTrials::read.
core::Result<store::ReleasedTrials> released_trials(Backend& backend, const std::string& study,
                                                    store::Tier least);

// CSV (RFC 4180): UTF-8, one header row, CR LF, empty cells for missing values, a decimal point in
// every locale. A text that a spreadsheet would read as a formula gets a leading apostrophe.

/// One row per person, study and rig: number of trials, answers, correct answers.
std::string summary_csv(const store::ReleasedTrials& trials);
/// One row per trial: participant, place in the study, whether it counts.
std::string trials_csv(const store::ReleasedTrials& trials);
/// One row per trial and score.
std::string scores_csv(const store::ReleasedTrials& trials);
/// One row per column of the tables above and of the arrays below: table, column, type, unit,
/// meaning.
std::string dictionary_csv();

/// The key of the pseudonyms: pseudonym, kind (account, participant, operator), name. Only for
/// administrators.
core::Result<std::string> key_csv(Backend& backend);

/// Highest sampling rate of the tier `reduced`.
inline constexpr double kReduced_Hz = 100.0;

}  // namespace tractus::api
