/// A trial's summary from a row that begins with its columns, and the rows that a list may have.
#pragma once

#include "db/store/trials/trials.hpp"

namespace tractus::store {

/// SQL: the name of the account to which the trial `t` was assigned; null for a trial of no
/// assignment.
inline constexpr const char* kPersonColumn =
    "(select pu.name from study_trials pt join study_slots ps on ps.id = pt.slot_id join "
    "assignment_people pp on pp.study_id = ps.study_id and pp.participant = ps.participant join "
    "accounts pu on pu.id = pp.account_id where pt.trial_id = t.id)";

/// Columns 0–10 as `summary_from` reads them, of trials t, cases c and stations s.
inline constexpr const char* kSummaryColumns =
    "t.id, t.case_id, c.title, s.name, t.operator_name, t.simulated, t.started_utc_us, "
    "t.duration_s, t.samples, t.state, t.correct";

/// Where those columns come from.
inline constexpr const char* kTrialsFrom =
    " from trials t join cases c on c.id = t.case_id join stations s on s.id = t.station_id ";

/// " and …" for the trials that `whose` reaches and that are not blind; its values are added.
std::string reached_sql(const TrialFilter& whose, std::vector<Value>& values);

/// Puts a trial into the list by which trials are found.
core::Result<void> add_trial_entry(Writing& tx, const std::string& id);
/// The same in the place of its row of before: what may be found of it has changed.
core::Result<void> renew_trial_entry(Writing& tx, const std::string& id);

/// Errors: corrupt for a state that is none.
core::Result<TrialSummary> summary_from(const Row& row);

}  // namespace tractus::store
