/// Work for later, queued in the transaction that makes it necessary, claimed by any process.
///
/// A claim lasts for a while (its lease) and is renewed while the work goes on. The job of a
/// process that died waits again when its lease is over; a process that was only slow is told by
/// `renew_claims` and `finish_job` that the job is not its own any more. The clocks of the
/// processes must agree to a few seconds, as they must for sessions.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Job {
  std::string id;
  std::string kind;            ///< "metrics", "lab"
  std::string subject;         ///< the trial's or the run's id
  std::uint64_t attempts = 0;  ///< this one included
  std::string owner = {};      ///< who claimed it
};

/// Who claims jobs, and how long a claim lasts unless it is renewed.
struct Worker {
  std::string id = {};
  std::int64_t lease_us = 30'000'000;
};

/// The channel on which the kind of a new job is told (signals.hpp).
inline constexpr const char* kJobsChannel = "jobs";

core::Result<void> queue_job(Writing& tx, const std::string& kind, const std::string& subject,
                             std::int64_t now_utc_us);
/// The oldest that waits and is of one of these kinds, now claimed; none when nothing waits. Right
/// beside other writes too (Store::write_beside): nobody waits for another's claim, and no job is
/// claimed twice.
core::Result<std::optional<Job>> claim_job(Writing& tx, const std::vector<std::string>& kinds,
                                           std::int64_t now_utc_us, const Worker& worker = {});
/// The worker still works. Returns the ids of the jobs that are still its own.
core::Result<std::vector<std::string>> renew_claims(Writing& tx, const Worker& worker,
                                                    std::int64_t now_utc_us);
/// Errors of both: conflict when the job is another's by now.
core::Result<void> finish_job(Writing& tx, const Job& job, std::int64_t now_utc_us);
core::Result<void> fail_job(Writing& tx, const Job& job, const std::string& why,
                            std::int64_t now_utc_us);
/// Left off, by nobody's fault: it waits again, and the attempt does not count.
core::Result<void> give_back_job(Writing& tx, const Job& job, std::int64_t now_utc_us);
/// Jobs whose lease is over wait again. Returns how many.
core::Result<std::uint64_t> requeue_lapsed_jobs(Writing& tx, std::int64_t now_utc_us);
/// What a process that died had claimed waits again, whatever its lease: for the start of the one
/// process on a database that is not shared.
core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us);

}  // namespace tractus::store
