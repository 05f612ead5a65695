#include "db/store/people/erasure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/people/erasure_steps.hpp"
#include "db/store/rows.hpp"
#include "db/store/trials/uploads.hpp"

namespace tractus {
namespace store {
namespace {

using core::Errc;
using core::Error;
using core::Result;

/// Values of a step's words.
using Words = std::map<std::string, Value, std::less<>>;

/// The statement with ? in place of :word, and the values in their order.
std::pair<std::string, std::vector<Value>> bound(const std::string& sql, const Words& words) {
  std::string out;
  std::vector<Value> values;
  for (std::size_t at = 0; at < sql.size(); ++at) {
    if (sql[at] != ':') {
      out += sql[at];
      continue;
    }
    std::size_t end = at + 1;
    while (end < sql.size() && sql[end] >= 'a' && sql[end] <= 'z') ++end;
    const auto word = words.find(std::string_view(sql).substr(at + 1, end - at - 1));
    core::require(word != words.end(), "a step of an erasure uses known words");
    values.push_back(word->second);
    out += '?';
    at = end - 1;
  }
  return {out, values};
}

/// Through Writing::query, which notes the rows that the audit trail covers. Returns the number of rows.
Result<std::uint64_t> run_step(Writing& tx, const ErasureStep& step, const Words& words) {
  const auto [sql, v] = bound(step.sql + " returning 1", words);
  const auto rows = [&, &sql = sql, &v = v]() -> Result<Rows> {
    switch (v.size()) {
      case 1:
        return tx.query(sql, {v[0]});
      case 2:
        return tx.query(sql, {v[0], v[1]});
      case 3:
        return tx.query(sql, {v[0], v[1], v[2]});
      default:
        core::require(false, "a step of an erasure has one to three values");
        return Rows();
    }
  }();
  if (!rows) return Error{rows.error().code, step.table + ": " + rows.error().what};
  return rows->size();
}

struct LeavingPerson {
  std::string name, badge;
};

Result<LeavingPerson> leaving_person(Reading& tx, const std::string& account_id) {
  auto rows =
      TRY(tx.query("select name, coalesce(badge, '') from accounts where id = ?", {account_id}));
  if (rows.empty()) return Error{Errc::not_found, "no account " + account_id.substr(0, 32)};
  if (TRY(is_erased(tx, account_id)))
    return Error{Errc::conflict, rows.front().text(0) + " is erased already"};
  return LeavingPerson{rows.front().text(0), rows.front().text(1)};
}

/// The wished number if nobody has it, else the next one.
Result<std::int64_t> free_number(Reading& tx, std::int64_t wished) {
  auto taken = TRY(tx.query("select 1 from erasures where number = ?", {wished}));
  if (wished > 0 && taken.empty()) return wished;
  auto rows = TRY(tx.query("select coalesce(max(number), 0) + 1 from erasures"));
  return rows.front().integer(0);
}

Result<void> check_alias(Reading& tx, const Erasure& erasure) {
  auto rows = TRY(tx.query("select 1 from accounts where name = ?", {erasure.alias()}));
  if (rows.empty()) return {};
  return Error{Errc::conflict, "an account is named \"" + erasure.alias() +
                                   "\", as an erased person is: disable it and erase it first"};
}

Result<void> count_files(Reading& tx, Departure& out) {
  auto rows = TRY(tx.query(
      "select u.size_bytes, case when u.state = 'receiving' then 1 else 0 end from erased_trials e "
      "join uploads u on u.trial_id = e.trial_id where e.erasure = ?",
      {out.erasure.number}));
  for (const Row& row : rows) {
    ++out.files;
    out.file_bytes += row.count(0);
    out.open_uploads += row.count(1);
  }
  return {};
}

Result<Erasure> erasure_from(const Row& row) {
  const auto mode = TRY(row.word<ErasureMode>(2, "erasures.mode"));
  const auto cause = TRY(row.word<ErasureCause>(3, "erasures.cause"));
  const auto state = TRY(row.word<ErasureState>(4, "erasures.state"));
  return Erasure{row.integer(0), row.text(1), mode, cause, state, row.integer(5)};
}

/// Under the lock of its upload: no piece and no commit is on its way then, and none comes after.
Result<void> delete_file(Store& store, const Objects& objects, const PartialFiles& partials,
                         const std::string& trial_id, const std::string& sha256) {
  const auto held = TRY(store.hold(upload_lock(trial_id)));
  partials.remove(trial_id);
  auto used = TRY(store.read(
      [&](Reading& tx) { return tx.query("select 1 from objects where sha256 = ?", {sha256}); }));
  if (used.empty()) TRY(objects.remove(sha256));
  TRY(store.write_beside([&](Writing& tx) {
    return tx.query("update erased_trials set deleted = 1 where trial_id = ?", {trial_id});
  }));
  return {};
}

Error left(const std::string& what) {
  return {Errc::conflict, what +
                              " belongs to a person whose data were erased: the server does not "
                              "take it; delete it from this station"};
}

}  // namespace

Result<Departure> begin_erasure(Writing& tx, const Erasure& wish) {
  Departure out{.erasure = wish, .rows = {}};
  const auto subject = TRY(leaving_person(tx, wish.account_id));
  out.erasure.number = TRY(free_number(tx, wish.number));
  out.erasure.state = ErasureState::begun;
  TRY(check_alias(tx, out.erasure));
  TRY(tx.query(
      "insert into erasures (number, account_id, mode, cause, state, name, badge, begun_utc_us) "
      "values (?, ?, ?, ?, ?, ?, ?, ?)",
      {out.erasure.number, wish.account_id, name_value(wish.mode), name_value(wish.cause),
       name_value(ErasureState::begun), subject.name, subject.badge, wish.begun_utc_us}));
  const Words words{{"account", wish.account_id},
                    {"name", subject.name},
                    {"badge", subject.badge},
                    {"alias", out.erasure.alias()},
                    {"number", out.erasure.number}};
  for (const ErasureStep& step : erasure_steps()) {
    if (step.only && *step.only != wish.mode) continue;
    const auto rows = TRY(run_step(tx, step, words));
    if (step.table == "erased_trials") TRY(count_files(tx, out));
    if (rows > 0) out.rows[step.table] += rows;
  }
  return out;
}

Result<Departure> preview_erasure(Store& store, const Erasure& wish) {
  Departure out;
  const auto tried = store.write([&](Writing& tx) -> Result<void> {
    const auto subject = TRY(leaving_person(tx, wish.account_id));
    out = TRY(begin_erasure(tx, wish));
    out.trail_rows = TRY(rows_naming(tx, {subject.name, subject.badge, out.erasure.alias()}));
    return Error{Errc::cancelled, "only looked"};
  });
  if (tried.error().code != Errc::cancelled) return tried.error();
  return out;
}

Result<void> finish_erasure(Store& store, const Objects& objects, const PartialFiles& partials,
                            std::int64_t number, std::int64_t now_utc_us) {
  struct Work {
    Rows files;
    std::string name, badge;
  };
  const auto work = TRY(store.read([&](Reading& tx) -> Result<Work> {
    auto files = TRY(tx.query(
        "select trial_id, sha256 from erased_trials where erasure = ? and deleted = 0", {number}));
    auto names = TRY(tx.query("select name, badge from erasures where number = ?", {number}));
    core::require(!names.empty(), "an erasure that is finished was begun");
    return Work{std::move(files), names.front().text(0), names.front().text(1)};
  }));
  for (const Row& file : work.files)
    TRY(delete_file(store, objects, partials, file.text(0), file.text(1)));
  if (!work.name.empty())
    TRY(redact_person(store, {work.name, work.badge, Erasure{.number = number}.alias()}));
  TRY(store.write([&](Writing& tx) {
    return tx.query(
        "update erasures set state = 'done', name = '', badge = '', done_utc_us = ? where number = "
        "? "
        "and state = 'begun'",
        {now_utc_us, number});
  }));
  return {};
}

Result<std::vector<std::int64_t>> unfinished_erasures(Reading& tx) {
  auto rows = TRY(tx.query("select number from erasures where state = 'begun' order by number"));
  std::vector<std::int64_t> out;
  for (const Row& row : rows) out.push_back(row.integer(0));
  return out;
}

Result<std::vector<Erasure>> all_erasures(Reading& tx) {
  return all_of(
      tx.query("select number, account_id, mode, cause, state, begun_utc_us from erasures "
               "order by number"),
      erasure_from);
}

Result<bool> is_erased(Reading& tx, const std::string& account_id) {
  auto rows = TRY(tx.query("select 1 from erasures where account_id = ?", {account_id}));
  return !rows.empty();
}

Result<void> check_slot_stays(Reading& tx, const std::string& slot_id) {
  auto rows = TRY(tx.query("select 1 from erased_slots where slot_id = ?", {slot_id}));
  if (rows.empty()) return {};
  return left("this trial");
}

Result<void> check_trial_stays(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(tx.query("select 1 from erased_trials where trial_id = ?", {trial_id}));
  if (rows.empty()) return {};
  return left("trial " + trial_id);
}

Result<std::vector<std::string>> erasure_findings(Reading& tx, const Objects& objects) {
  std::vector<std::string> out;
  const auto begun = TRY(unfinished_erasures(tx));
  for (const std::int64_t number : begun)
    out.push_back(
        fmt::format("erasure {}: not finished; the server finishes it at its next start", number));
  auto rows =
      TRY(tx.query("select e.sha256 from erased_trials e where e.deleted = 1 and not exists "
                   "(select 1 from objects "
                   "o where o.sha256 = e.sha256) order by e.sha256"));
  for (const Row& row : rows)
    if (TRY(objects.size_of(row.text(0))).has_value())
      out.push_back(
          fmt::format("object {}: is the file of an erased trial and still here", row.text(0)));
  return out;
}

}  // namespace store
}  // namespace tractus
