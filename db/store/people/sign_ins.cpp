#include "db/store/people/sign_ins.hpp"

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

core::Result<void> run_statement(Writing& tx, std::string_view sql,
                                 std::initializer_list<Value> values) {
  TRY(tx.query(sql, values));
  return {};
}

std::string text_of(Secret secret) {
  switch (secret) {
    case Secret::account_password:
      return "account_password";
    case Secret::badge_pin:
      return "badge_pin";
    case Secret::enrolment_code:
      return "enrolment_code";
    case Secret::own_password:
      return "own_password";
    case Secret::api_token:
      return "api_token";
  }
  return "";
}

std::string text_of(Total total) {
  switch (total) {
    case Total::pair:
      return "pair";
    case Total::name:
      return "name";
    case Total::origin:
      return "origin";
  }
  return "";
}

/// Of a row of sign_in_failures.
struct Key {
  std::string secret, total, name, origin;
  Key(const Attempt& attempt, Total of)
      : secret(text_of(attempt.secret)),
        total(text_of(of)),
        name(of == Total::origin ? "" : attempt.name),
        origin(of == Total::name ? "" : attempt.origin) {}
};

}  // namespace

core::Result<Failures> failures_of(Reading& tx, const Attempt& attempt, Total total) {
  const Key key(attempt, total);
  auto rows =
      TRY(tx.query("select failures, at_utc_us from sign_in_failures "
                   "where secret = ? and total = ? and name = ? and origin = ?",
                   {key.secret, key.total, key.name, key.origin}));
  if (rows.empty()) return Failures{};
  return Failures{rows.front().number(0), rows.front().integer(1)};
}

core::Result<void> set_failures(Writing& tx, const Attempt& attempt, Total total,
                                const Failures& failures) {
  const Key key(attempt, total);
  return run_statement(
      tx,
      "insert into sign_in_failures (secret, total, name, origin, failures, at_utc_us) "
      "values (?, ?, ?, ?, ?, ?) on conflict (secret, total, name, origin) do update "
      "set failures = excluded.failures, at_utc_us = excluded.at_utc_us",
      {key.secret, key.total, key.name, key.origin, failures.count, failures.at_utc_us});
}

core::Result<void> clear_failures(Writing& tx, const Attempt& attempt) {
  const Key key(attempt, Total::pair);
  return run_statement(tx,
                       "delete from sign_in_failures "
                       "where secret = ? and total = ? and name = ? and origin = ?",
                       {key.secret, key.total, key.name, key.origin});
}

core::Result<void> clear_failures_of_name(Writing& tx, Secret secret, const std::string& name) {
  return run_statement(tx,
                       "delete from sign_in_failures where secret = ? and total <> ? and name = ?",
                       {text_of(secret), text_of(Total::origin), name});
}

core::Result<void> remove_old_failures(Writing& tx, std::int64_t before_utc_us) {
  return run_statement(tx, "delete from sign_in_failures where at_utc_us < ?", {before_utc_us});
}

core::Result<bool> is_known_origin(Reading& tx, const Attempt& attempt) {
  const bool by_badge = attempt.secret == Secret::badge_pin;
  auto rows = TRY(
      tx.query(std::string("select 1 from known_origins k join accounts a on a.id = k.account_id "
                           "where k.secret = ? and k.origin = ? and ") +
                   (by_badge ? "a.badge = ?" : "a.name = ?"),
               {text_of(attempt.secret), attempt.origin, attempt.name}));
  return !rows.empty();
}

core::Result<bool> is_known_origin(Reading& tx, Secret secret, const std::string& origin) {
  auto rows = TRY(tx.query("select 1 from known_origins where secret = ? and origin = ? limit 1",
                           {text_of(secret), origin}));
  return !rows.empty();
}

core::Result<void> note_origin(Writing& tx, const std::string& account_id, const Attempt& from,
                               std::int64_t now_utc_us, std::int64_t forget_before_utc_us) {
  TRY(run_statement(tx, "delete from known_origins where account_id = ? and seen_utc_us < ?",
                    {account_id, forget_before_utc_us}));
  return run_statement(tx,
                       "insert into known_origins (account_id, secret, origin, seen_utc_us) "
                       "values (?, ?, ?, ?) on conflict (account_id, secret, origin) do update "
                       "set seen_utc_us = excluded.seen_utc_us",
                       {account_id, text_of(from.secret), from.origin, now_utc_us});
}

core::Result<void> forget_origins(Writing& tx, const std::string& account_id, Secret secret) {
  return run_statement(tx, "delete from known_origins where account_id = ? and secret = ?",
                       {account_id, text_of(secret)});
}

}  // namespace store
}  // namespace tractus
