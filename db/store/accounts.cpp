#include "db/store/accounts.hpp"

namespace store {
namespace {

core::Result<void> run(Writing& tx, std::string_view sql, std::initializer_list<Value> values) {
  auto done = tx.query(sql, values);
  if (!done) return done.error();
  return {};
}

/// Columns id, name, role, password_hash.
Account account_from(const Row& row) {
  return {row.text(0), row.text(1), row.text(2), row.text(3)};
}

core::Result<std::string> station_text(Reading& tx, const std::string& column,
                                       const std::string& station_id) {
  auto rows = tx.query("select " + column + " from stations where id = ?", {station_id});
  if (!rows) return rows.error();
  if (rows->empty()) return core::Error{core::Errc::not_found, "no such station"};
  return rows->front().text(0);
}

}  // namespace

core::Result<void> add_account(Writing& tx, const Account& account, std::int64_t now_utc_us) {
  auto done = run(tx,
                  "insert into accounts (id, name, role, password_hash, made_utc_us) "
                  "values (?, ?, ?, ?, ?)",
                  {account.id, account.name, account.role, account.password_hash, now_utc_us});
  if (!done && done.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict,
                       "an account named " + account.name + " exists already"};
  return done;
}

core::Result<std::optional<Account>> account_named(Reading& tx, const std::string& name) {
  auto rows = tx.query("select id, name, role, password_hash from accounts where name = ?", {name});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<Account>();
  return std::optional(account_from(rows->front()));
}

core::Result<std::uint64_t> account_count(Reading& tx) {
  auto rows = tx.query("select count(*) from accounts");
  if (!rows) return rows.error();
  return rows->front().count(0);
}

core::Result<void> add_session(Writing& tx, const std::string& token_hash,
                               const std::string& account_id, std::int64_t now_utc_us) {
  return run(tx,
             "insert into sessions (token_hash, account_id, made_utc_us, seen_utc_us) "
             "values (?, ?, ?, ?)",
             {token_hash, account_id, now_utc_us, now_utc_us});
}

core::Result<std::optional<Session>> session_of(Reading& tx, const std::string& token_hash) {
  auto rows = tx.query(
      "select a.id, a.name, a.role, a.password_hash, s.made_utc_us, s.seen_utc_us "
      "from sessions s join accounts a on a.id = s.account_id where s.token_hash = ?",
      {token_hash});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<Session>();
  const Row& row = rows->front();
  return std::optional(Session{account_from(row), row.integer(4), row.integer(5)});
}

core::Result<void> touch_session(Writing& tx, const std::string& token_hash,
                                 std::int64_t now_utc_us) {
  return run(tx, "update sessions set seen_utc_us = ? where token_hash = ?",
             {now_utc_us, token_hash});
}

core::Result<void> remove_session(Writing& tx, const std::string& token_hash) {
  return run(tx, "delete from sessions where token_hash = ?", {token_hash});
}

core::Result<void> remove_old_sessions(Writing& tx, std::int64_t unseen_since_utc_us,
                                       std::int64_t made_before_utc_us) {
  return run(tx, "delete from sessions where seen_utc_us < ? or made_utc_us < ?",
             {unseen_since_utc_us, made_before_utc_us});
}

core::Result<void> add_station(Writing& tx, const Station& station, const std::string& token_hash,
                               std::int64_t now_utc_us) {
  auto done =
      run(tx, "insert into stations (id, name, token_hash, enrolled_utc_us) values (?, ?, ?, ?)",
          {station.id, station.name, token_hash, now_utc_us});
  if (!done && done.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict, "a station named " + station.name + " exists already"};
  return done;
}

core::Result<std::optional<Station>> station_of(Reading& tx, const std::string& token_hash) {
  auto rows = tx.query("select id, name from stations where token_hash = ?", {token_hash});
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<Station>();
  return std::optional(Station{rows->front().text(0), rows->front().text(1)});
}

core::Result<std::string> station_token_hash(Reading& tx, const std::string& station_id) {
  return station_text(tx, "token_hash", station_id);
}

core::Result<std::string> station_name(Reading& tx, const std::string& station_id) {
  return station_text(tx, "name", station_id);
}

core::Result<Failures> login_failures(Reading& tx, const std::string& name, const std::string& peer,
                                      std::int64_t since_utc_us) {
  auto rows = tx.query(
      "select count(*), coalesce(sum(case when peer = ? then 1 else 0 end), 0) "
      "from login_failures where name = ? and at_utc_us >= ?",
      {peer, name, since_utc_us});
  if (!rows) return rows.error();
  return Failures{.from_peer = rows->front().count(1), .for_name = rows->front().count(0)};
}

core::Result<void> add_login_failure(Writing& tx, const std::string& name, const std::string& peer,
                                     std::int64_t now_utc_us, std::int64_t forget_before_utc_us) {
  auto forgotten =
      run(tx, "delete from login_failures where at_utc_us < ?", {forget_before_utc_us});
  if (!forgotten) return forgotten;
  return run(tx, "insert into login_failures (name, peer, at_utc_us) values (?, ?, ?)",
             {name, peer, now_utc_us});
}

core::Result<void> clear_login_failures(Writing& tx, const std::string& name,
                                        const std::string& peer) {
  return run(tx, "delete from login_failures where name = ? and peer = ?", {name, peer});
}

}  // namespace store
