/// Scores a committed trial.
#pragma once

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// Reads the trial and its case, computes every metric and the wall coverage, and stores them in
/// one transaction: the trial is then "assessed". Doing it again puts the same in place. Errors:
/// not_found, corrupt and others of reading, naming the trial or the part.
core::Result<void> assess_trial(store::Store& store, const store::Objects& objects,
                                const std::string& trial_id);

}  // namespace tractus::jobs
