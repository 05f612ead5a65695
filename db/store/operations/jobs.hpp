/// Jobs: work for later, queued in the transaction that makes it necessary, claimed by any process.
///
/// A claim has a lease, which is renewed while the work continues. When the lease of a dead process
/// has expired, its job is queued again; a process that was only slow learns from `renew_claims`
/// and `finish_job` that it lost the job. The clocks of the processes must agree within a few
/// seconds, as they must for sessions.
#pragma once

#include <vector>

#include "core/named.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

/// What a job works on.
enum class JobKind {
  metrics,   ///< the scores of a trial
  lab,       ///< a run of the model lab
  analysis,  ///< a run of a cohort's analysis
  making,    ///< a case made from a volume
  felt,      ///< the certificate of a case that was made without one
};
constexpr auto words(JobKind) {
  using enum JobKind;
  return std::to_array<core::Word<JobKind>>({{metrics, "metrics"},
                                             {lab, "lab"},
                                             {analysis, "analysis"},
                                             {making, "case"},
                                             {felt, "felt"}});
}

/// How far the work on a case has come.
enum class WorkState { queued, running, done, failed };
constexpr auto words(WorkState) {
  using enum WorkState;
  return std::to_array<core::Word<WorkState>>(
      {{queued, "queued"}, {running, "running"}, {done, "done"}, {failed, "failed"}});
}

struct Job {
  std::string id;
  JobKind kind = JobKind::metrics;
  std::string subject;           ///< the trial's or the run's id
  std::uint64_t attempts = 0;    ///< number of attempts, including the current one
  std::string owner = {};        ///< worker that claimed it
  std::string traceparent = {};  ///< of the request that queued it; empty: none
};

/// A worker that claims jobs, and the length of its leases.
struct Worker {
  std::string id = {};
  std::int64_t lease_us = 30'000'000;
};

/// The channel that signals the kind of a new job (signals.hpp).
inline constexpr const char* kJobsChannel = "jobs";

core::Result<void> queue_job(Writing& tx, JobKind kind, const std::string& subject,
                             std::int64_t now_utc_us, const std::string& traceparent = {});
/// Claims the oldest queued job of one of these kinds; none if no such job is queued. Also correct
/// in Store::write_beside: workers do not wait for each other, and no job is claimed twice.
core::Result<std::optional<Job>> claim_job(Writing& tx, const std::vector<JobKind>& kinds,
                                           std::int64_t now_utc_us, const Worker& worker = {});
/// Renews the leases of the worker. Returns the ids of the jobs that the worker still owns.
core::Result<std::vector<std::string>> renew_claims(Writing& tx, const Worker& worker,
                                                    std::int64_t now_utc_us);
/// Errors of both: conflict if the job now belongs to another worker.
core::Result<void> finish_job(Writing& tx, const Job& job, std::int64_t now_utc_us);
core::Result<void> fail_job(Writing& tx, const Job& job, const std::string& why,
                            std::int64_t now_utc_us);
/// Puts a job back into the queue after an interruption; the attempt does not count.
core::Result<void> give_back_job(Writing& tx, const Job& job, std::int64_t now_utc_us);
/// Puts jobs with an expired lease back into the queue. Returns their number.
core::Result<std::uint64_t> requeue_lapsed_jobs(Writing& tx, std::int64_t now_utc_us);
/// Puts all claimed jobs back into the queue, whatever their lease: for the start of the only
/// process on a database that is not shared.
core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us);

}  // namespace tractus::store
