/// The steps of commit_upload: from a complete partial file to a stored trial.
#pragma once

#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// Checks the partial file with bounded memory: its SHA-256, then every frame. Errors: corrupt
/// (another size or SHA-256, an invalid frame), bad_input (not sealed, another id or case, no
/// samples), too_large (too many samples).
core::Result<store::TrialRecord> checked_trial(Backend& backend, const store::Upload& upload);

/// Moves the file to the objects, then in one transaction adds object, trial and job and completes
/// the upload. @param traceparent  of the job; empty: none
core::Result<void> store_trial(Backend& backend, const store::Upload& upload,
                               const store::TrialRecord& trial, const std::string& traceparent);

}  // namespace tractus::api
