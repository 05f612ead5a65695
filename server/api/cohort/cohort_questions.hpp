/// Requests for cohort analyses: locks plans, and queues analyses as jobs.
#pragma once

#include "db/store/cohort/analyses.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// {"plan", "study"?, "data_seen"?}: locks the plan in the caller's name and stores it. If the
/// server already has scored trials for the plan, the data count as seen, whatever "data_seen"
/// states. Errors: bad_input naming the field of the body or of the plan; conflict for a plan that
/// already has a lock.
core::Result<store::AnalysisPlan> locked_plan(Backend& backend, const core::Json& asked,
                                              const std::string& who);

/// {"plan", "snapshot"?}, or {"method", "formula", "options"?, "study"?}: queues a run. A method
/// without a plan becomes an unlocked plan of one analysis, and the result states this. Errors:
/// bad_input naming the field, also for a snapshot that no analysis of the plan used.
core::Result<store::AnalysisRun> queued_analysis(Backend& backend, const core::Json& asked,
                                                 const std::string& who);

/// Checks that all trials of these data (an object: CSV, one row per trial) are still released for
/// research. Errors: forbidden if a trial is not: its consent was withdrawn, or the data were
/// frozen before consent was required.
core::Result<void> check_still_released(Backend& backend, const std::string& study,
                                        const std::string& data);

/// The dictionary of a finished run's data.
core::Result<http::Response> dictionary_response(Backend& backend, const store::AnalysisRun& run);

}  // namespace tractus::api
