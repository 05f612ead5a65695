/// Trials for research: tidy tables, one row each thing, and signals as arrays, of released trials
/// alone (db/store/cohort/released.hpp).
#pragma once

#include "db/store/cohort/released.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// The trials of a study (empty: all) of which `least` may be had. Errors: those of
/// store::ReleasedTrials::read.
core::Result<store::ReleasedTrials> released_trials(Backend& backend, const std::string& study,
                                                    store::Tier least);

// As CSV (RFC 4180): UTF-8, one header row, CR LF, NA empty, a point in numbers whatever the
// locale. A text that a spreadsheet would take for a formula begins with an apostrophe.

/// One row per person, study and rig: how many trials, answers, right answers.
std::string summary_csv(const store::ReleasedTrials& trials);
/// One row per trial: who, which place in which study, what of it counts.
std::string trials_csv(const store::ReleasedTrials& trials);
/// One row per trial and score.
std::string scores_csv(const store::ReleasedTrials& trials);
/// One row per column of the tables above and of the arrays below: table, column, type, unit, what
/// it is.
std::string dictionary_csv();

/// Who is who: pseudonym, kind (account, participant, operator), name. For administrators alone.
core::Result<std::string> key_csv(Backend& backend);

/// The rate up to which samples are of the tier `reduced`.
inline constexpr double kReduced_Hz = 100.0;

}  // namespace tractus::api
