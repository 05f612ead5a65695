/// Certificates of cases that were made without one.
#pragma once

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// Tries a case that nobody has tried, from its drilled volume alone (cases::certify_drilled), and
/// marks it: its certificate becomes a secret part, which is not signed with the case. A case whose
/// bone does not say is marked as not known. Of a case that is marked nothing changes.
/// Errors: not_found, those of reading.
core::Result<void> certify_case(store::Store& store, const store::Objects& objects,
                                const std::string& case_id);

/// Queues the job for every untried case: those that an older version left behind.
core::Result<void> queue_untried_cases(store::Store& store);

}  // namespace tractus::jobs
