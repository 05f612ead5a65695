/// Work for later, queued in the transaction that makes it necessary.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace store {

struct Job {
  std::string id;
  std::string kind;            ///< "metrics", "lab"
  std::string subject;         ///< the trial's or the run's id
  std::uint64_t attempts = 0;  ///< this one included
};

core::Result<void> queue_job(Writing& tx, const std::string& kind, const std::string& subject,
                             std::int64_t now_utc_us);
/// The oldest that waits and is of one of these kinds, now claimed; none when nothing waits.
core::Result<std::optional<Job>> claim_job(Writing& tx, const std::vector<std::string>& kinds,
                                           std::int64_t now_utc_us);
core::Result<void> finish_job(Writing& tx, const std::string& id, std::int64_t now_utc_us);
core::Result<void> fail_job(Writing& tx, const std::string& id, const std::string& why,
                            std::int64_t now_utc_us);
/// What a process that died had claimed waits again. For the start of the one process that works on
/// jobs.
core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us);

}  // namespace store
