/// A trial's summary from a row that begins with its columns.
#pragma once

#include "db/store/trials/trials.hpp"

namespace tractus::store {

/// Columns 0–10 as `summary_from` reads them, of trials t, cases c and stations s.
inline constexpr const char* kSummaryColumns =
    "t.id, t.case_id, c.title, s.name, t.operator_name, t.simulated, t.started_utc_us, "
    "t.duration_s, t.samples, t.state, t.correct";

/// Errors: corrupt for a state that is none.
core::Result<TrialSummary> summary_from(const Row& row);

}  // namespace tractus::store
