#include "db/store/jobs.hpp"

#include "core/bytes.hpp"
#include "core/require.hpp"

namespace store {
namespace {

core::Result<void> set_state(Writing& tx, const std::string& id, const char* state,
                             const std::string& error, std::int64_t now_utc_us) {
  auto done = tx.query("update jobs set state = ?, error = ?, changed_utc_us = ? where id = ?",
                       {state, error, now_utc_us, id});
  if (!done) return done.error();
  return {};
}

}  // namespace

core::Result<void> queue_job(Writing& tx, const std::string& kind, const std::string& subject,
                             std::int64_t now_utc_us) {
  auto done = tx.query(
      "insert into jobs (id, kind, subject, state, attempts, error, queued_utc_us, changed_utc_us) "
      "values (?, ?, ?, 'queued', 0, '', ?, ?)",
      {core::new_id(), kind, subject, now_utc_us, now_utc_us});
  if (!done) return done.error();
  return {};
}

core::Result<std::optional<Job>> claim_job(Writing& tx, const std::vector<std::string>& kinds,
                                           std::int64_t now_utc_us) {
  core::require(!kinds.empty(), "whoever claims a job says of which kinds");
  std::string listed = ",";
  for (const std::string& kind : kinds) listed += kind + ",";
  auto rows = tx.query(
      "update jobs set state = 'claimed', attempts = attempts + 1, changed_utc_us = ? "
      "where id = (select id from jobs where state = 'queued' and ? like '%,' || kind || ',%' "
      "order by queued_utc_us, id limit 1) "
      "returning id, kind, subject, attempts",
      {now_utc_us, listed});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<Job>();
  const Row& row = rows->front();
  return std::optional(Job{row.text(0), row.text(1), row.text(2), row.count(3)});
}

core::Result<void> finish_job(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  return set_state(tx, id, "done", "", now_utc_us);
}

core::Result<void> fail_job(Writing& tx, const std::string& id, const std::string& why,
                            std::int64_t now_utc_us) {
  return set_state(tx, id, "failed", why, now_utc_us);
}

core::Result<void> requeue_claimed_jobs(Writing& tx, std::int64_t now_utc_us) {
  auto done = tx.query(
      "update jobs set state = 'queued', changed_utc_us = ? where state = 'claimed'", {now_utc_us});
  if (!done) return done.error();
  return {};
}

}  // namespace store
