/// What a trial with a burr has beyond one with a probe.
#pragma once

#include "station/loop/drilling.hpp"
#include "station/session/prepared_case.hpp"

namespace tractus::session {

/// What it came to: the detail of the trial's "drilled" event.
core::Json drilled_detail(const loop::Drilling& drilling, const PreparedCase& prepared);

/// The state of a drilled bone beside the trials, where `prepare_case` finds it. Errors: io.
core::Result<void> keep_drilled(const StationFolder& folder, const loop::Drilling& drilling,
                                const std::string& trial_id, const std::string& case_id);

/// Puts what a trial drilled into the case's volume: from the kept state, else (a trial that was
/// cut short) by drilling its file again: one that names another case must leave the very bone that
/// it says it left. Returns what was worn, also where that left no trace in the counts (marrow like
/// water): only the file knows that; nothing without it. Errors: not_found (neither is here),
/// bad_input (a trial of another case, or one that drilled nothing), corrupt, io.
core::Result<drilling::ErodedShares> put_drilled(const StationFolder& folder,
                                                 const std::string& trial_id,
                                                 const std::string& case_id, volume::Volume& bone);

}  // namespace tractus::session
