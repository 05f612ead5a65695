#include "db/store/learning/record_stores.hpp"

#include "core/try.hpp"
#include "db/store/operations/deliveries.hpp"
#include "db/store/people/consent.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::size_t kMostQueued = 200;

core::Result<RecordStore> record_store_from(const Row& row) {
  return RecordStore{row.text(0), row.text(1),    row.text(2),
                     row.text(3), row.integer(4), row.text(5)};
}

core::Result<StatementTrial> statement_trial_from(const Row& row) {
  return StatementTrial{row.text(0), row.text(1)};
}

/// Candidates with the account that did them: whoever consented to nothing is left out here, the
/// tier itself is checked by ConsentBook.
constexpr const char* kCandidates =
    "select m.trial_id, k.study_id, p.account_id from record_stores r cross join study_trials m "
    "join study_slots k on k.id = m.slot_id join assignments a on a.study_id = k.study_id join "
    "assignment_people p on p.study_id = k.study_id and p.participant = k.participant join trials "
    "t on t.id = m.trial_id where m.state = 'counts' and t.state = 'assessed' and t.complete = 1 "
    "and t.received_utc_us >= r.made_utc_us and a.release <> 'held' and exists (select 1 from "
    "consents c where c.account_id = p.account_id and c.tier in ('metrics', 'reduced', 'full')) "
    "and not exists (select 1 from record_statements s where s.trial_id = m.trial_id and "
    "s.store_id = r.id) order by t.received_utc_us, m.trial_id";

}  // namespace

core::Result<std::optional<RecordStore>> record_store(Reading& tx) {
  return one_of(
      tx.query("select id, endpoint, key, secret, made_utc_us, made_by from record_stores"),
      record_store_from);
}

core::Result<void> set_record_store(Writing& tx, const RecordStore& wanted) {
  const auto earlier = TRY(record_store(tx));
  if (earlier) TRY(remove_record_store(tx, wanted.made_utc_us));
  return done(tx.query(
      "insert into record_stores (id, endpoint, key, secret, made_utc_us, made_by) values (?, ?, "
      "?, ?, ?, ?)",
      {wanted.id, wanted.endpoint, wanted.key, wanted.secret, wanted.made_utc_us, wanted.made_by}));
}

core::Result<void> remove_record_store(Writing& tx, std::int64_t now_utc_us) {
  const auto found = TRY(record_store(tx));
  if (!found) return core::Error{core::Errc::not_found, "no learning record store is stated"};
  TRY(tx.query("delete from record_statements where store_id = ?", {found->id}));
  TRY(tx.query("delete from record_stores where id = ?", {found->id}));
  return withdraw_deliveries(tx, Channel::xapi, found->id, now_utc_us);
}

core::Result<std::vector<StatementTrial>> trials_to_state(Reading& tx) {
  const auto rows = TRY(tx.query(kCandidates));
  std::vector<StatementTrial> out;
  if (rows.empty()) return out;
  const auto book = TRY(ConsentBook::read(tx));
  for (const Row& row : rows)
    if (out.size() < kMostQueued && book.tier_of(row.text(2), row.text(1)) >= Tier::metrics)
      out.push_back({row.text(0), row.text(1)});
  return out;
}

core::Result<void> queue_statements(Writing& tx, std::int64_t now_utc_us) {
  const auto store = TRY(record_store(tx));
  if (!store) return {};
  const auto trials = TRY(trials_to_state(tx));
  for (const StatementTrial& one : trials) {
    const auto id = TRY(queue_delivery(tx, Channel::xapi, store->id, now_utc_us));
    TRY(tx.query(
        "insert into record_statements (trial_id, store_id, study_id, delivery_id) values (?, ?, "
        "?, ?)",
        {one.trial_id, store->id, one.study_id, id}));
  }
  return {};
}

core::Result<std::optional<StatementTrial>> stated_trial(Reading& tx,
                                                         const std::string& delivery_id) {
  return one_of(
      tx.query("select s.trial_id, s.study_id from record_statements s join assignments a on "
               "a.study_id = s.study_id where s.delivery_id = ? and a.release <> 'held'",
               {delivery_id}),
      statement_trial_from);
}

}  // namespace store
}  // namespace tractus
