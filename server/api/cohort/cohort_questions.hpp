/// What is asked of a cohort: plans to lock, and analyses to run as jobs.
#pragma once

#include "db/store/cohort/analyses.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// {"plan", "study"?, "data_seen"?}: locks the plan in the caller's name and keeps it. Where the
/// server holds scored trials of it already, its data count as seen, whatever was said. Errors:
/// bad_input naming the field of the body or of the plan; conflict for a plan that has a lock.
core::Result<store::AnalysisPlan> locked_plan(Backend& backend, const core::Json& asked,
                                              const std::string& who);

/// {"plan", "snapshot"?}, or {"method", "formula", "options"?, "study"?}: a run, queued. A method
/// without a plan becomes a plan of one analysis that nobody locked, and says so. Errors: bad_input
/// naming the field, also for a snapshot that no analysis of the plan was of.
core::Result<store::AnalysisRun> queued_analysis(Backend& backend, const core::Json& asked,
                                                 const std::string& who);

/// May all of these data (an object: CSV, a row a trial) be had still? Errors: forbidden when a
/// trial of them may not: consent was withdrawn, or they were frozen before it was asked.
core::Result<void> check_still_released(Backend& backend, const std::string& study,
                                        const std::string& data);

/// The dictionary of a finished run's data.
core::Result<http::Response> dictionary_response(Backend& backend, const store::AnalysisRun& run);

}  // namespace tractus::api
