/// Runs an analysis plan on the cohort.
#pragma once

#include <functional>

#include "db/store/people/pseudonyms.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// Freezes the cohort's table, unless the run names a snapshot, and runs the plan on it: result,
/// report and marked data become objects, noted in one transaction. A locked plan must be as it was
/// locked. Nothing is done for a run that ended already.
/// @param key  of the pseudonyms that the table names people and trials by.
/// @param ending  true when the server wants to end.
/// Errors: not_found, unavailable (no key), too_large (over 100 000 trials), those of reading and
/// of the plan; bad_input where a run without a locked plan could not be done; cancelled when
/// someone stopped it, or the server ends.
core::Result<void> analyse(store::Store& store, const store::Objects& objects,
                           const std::optional<store::PseudonymKey>& key,
                           const std::string& analysis_id, const std::function<bool()>& ending);

}  // namespace tractus::jobs
