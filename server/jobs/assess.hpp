/// Scores a committed trial.
#pragma once

#include "db/store/objects.hpp"
#include "db/store/store.hpp"

namespace jobs {

/// Reads the trial and its case, computes every metric and the wall coverage, and stores them in
/// one transaction: the trial is then "assessed". Doing it again puts the same in place. Errors:
/// not_found, corrupt and others of reading, naming the trial or the part.
core::Result<void> assess_trial(store::Store& store, const store::Objects& objects,
                                const std::string& trial_id);

}  // namespace jobs
