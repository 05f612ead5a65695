/// From a whole partial file to a trial: the steps of commit_upload.
#pragma once

#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// Reads the partial file, in bounded memory: SHA-256, then every frame. Errors: corrupt (another
/// size or SHA-256, a frame that does not hold), bad_input (not sealed, another id or case, no
/// samples), too_large (too many samples).
core::Result<store::TrialRecord> checked_trial(Backend& backend, const store::Upload& upload);

/// The file among the objects, then one transaction: object, trial, upload complete, job.
core::Result<void> store_trial(Backend& backend, const store::Upload& upload,
                               const store::TrialRecord& trial);

}  // namespace tractus::api
