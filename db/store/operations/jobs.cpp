#include "db/store/operations/jobs.hpp"

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

/// Only while it is the owner's.
core::Result<void> set_state(Writing& tx, const Job& job, const char* state,
                             const std::string& error, std::int64_t uncounted_attempts,
                             std::int64_t now_utc_us) {
  auto rows = TRY(
      tx.query("update jobs set state = ?, error = ?, attempts = attempts - ?, changed_utc_us = ? "
               "where id = ? and owner = ? and state = 'claimed' returning id",
               {state, error, uncounted_attempts, now_utc_us, job.id, job.owner}));
  if (rows.empty())
    return core::Error{core::Errc::conflict, "job " + job.id + " now belongs to another server"};
  return {};
}

}  // namespace

core::Result<void> queue_job(Writing& tx, JobKind kind, const std::string& subject,
                             std::int64_t now_utc_us, const std::string& traceparent) {
  TRY(tx.query(
      "insert into jobs (id, kind, subject, state, attempts, error, queued_utc_us, changed_utc_us, "
      "traceparent) values (?, ?, ?, 'queued', 0, '', ?, ?, ?)",
      {core::new_id(), name_value(kind), subject, now_utc_us, now_utc_us, traceparent}));
  return notify(tx, kJobsChannel, std::string(core::name(kind)));
}

core::Result<std::optional<Job>> claim_job(Writing& tx, const std::vector<JobKind>& kinds,
                                           std::int64_t now_utc_us, const Worker& worker) {
  core::require(!kinds.empty(), "whoever claims a job says of which kinds");
  std::string listed = ",";
  for (const JobKind kind : kinds) listed += std::string(core::name(kind)) + ",";
  auto rows = TRY(tx.query(
      "update jobs set state = 'claimed', attempts = attempts + 1, owner = ?, "
      "lease_until_utc_us = ?, changed_utc_us = ? "
      "where id = (select id from jobs where state = 'queued' and ? like '%,' || kind || ',%' "
      "order by queued_utc_us, id limit 1 /*pg: for update skip locked */) "
      "returning id, kind, subject, attempts, traceparent",
      {worker.id, now_utc_us + worker.lease_us, now_utc_us, listed}));
  if (rows.empty()) return std::optional<Job>();
  const Row& row = rows.front();
  const auto kind = TRY(row.word<JobKind>(1, "jobs.kind"));
  return std::optional(Job{row.text(0), kind, row.text(2), row.count(3), worker.id, row.text(4)});
}

core::Result<std::vector<std::string>> renew_claims(Writing& tx, const Worker& worker,
                                                    std::int64_t now_utc_us) {
  auto rows = TRY(tx.query(
      "update jobs set lease_until_utc_us = ? where owner = ? and state = 'claimed' returning id",
      {now_utc_us + worker.lease_us, worker.id}));
  std::vector<std::string> out;
  for (const Row& row : rows) out.push_back(row.text(0));
  return out;
}

core::Result<void> finish_job(Writing& tx, const Job& job, std::int64_t now_utc_us) {
  return set_state(tx, job, "done", "", 0, now_utc_us);
}

core::Result<void> fail_job(Writing& tx, const Job& job, const std::string& why,
                            std::int64_t now_utc_us) {
  return set_state(tx, job, "failed", why, 0, now_utc_us);
}

core::Result<void> give_back_job(Writing& tx, const Job& job, std::int64_t now_utc_us) {
  TRY(set_state(tx, job, "queued", "", 1, now_utc_us));
  return notify(tx, kJobsChannel, std::string(core::name(job.kind)));
}

core::Result<std::uint64_t> requeue_lapsed_jobs(Writing& tx, std::int64_t now_utc_us) {
  auto rows = TRY(
      tx.query("update jobs set state = 'queued', changed_utc_us = ? where state = 'claimed' and "
               "lease_until_utc_us < ? returning id",
               {now_utc_us, now_utc_us}));
  if (rows.empty()) return 0;
  TRY(notify(tx, kJobsChannel, "lapsed"));
  return rows.size();
}

core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us) {
  TRY(tx.query("update jobs set state = 'queued', changed_utc_us = ? where state = 'claimed'",
               {now_utc_us}));
  return {};
}

}  // namespace store
}  // namespace tractus
