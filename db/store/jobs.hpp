/// Work for later, queued in the transaction that makes it necessary.
#pragma once

#include "db/store/store.hpp"

namespace store {

struct Job {
  std::string id;
  std::string kind;            ///< "metrics"
  std::string subject;         ///< the trial's id
  std::uint64_t attempts = 0;  ///< this one included
};

core::Result<void> queue_job(Writing& tx, const std::string& kind, const std::string& subject,
                             std::int64_t now_utc_us);
/// The oldest that waits, now claimed; none when nothing waits.
core::Result<std::optional<Job>> claim_job(Writing& tx, std::int64_t now_utc_us);
core::Result<void> finish_job(Writing& tx, const std::string& id, std::int64_t now_utc_us);
core::Result<void> fail_job(Writing& tx, const std::string& id, const std::string& why,
                            std::int64_t now_utc_us);
/// What a process that died had claimed waits again. For the start of the one process that works on
/// jobs.
core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us);

}  // namespace store
