#include "db/store/people/accounts.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

core::Result<void> run(Writing& tx, std::string_view sql, std::initializer_list<Value> values) {
  TRY(tx.query(sql, values));
  return {};
}

constexpr const char* kAccount =
    "a.id, a.name, a.role, a.password_hash, a.state, coalesce(a.pseudonym, ''), "
    "coalesce(a.badge, ''), coalesce(a.pin_hash, ''), coalesce(a.totp_secret, ''), "
    "a.totp_confirmed, a.totp_step, a.must_change, a.made_utc_us, a.level, a.language";
constexpr std::size_t kAccountColumns = 15;

/// Columns of kAccount.
core::Result<Account> account_from(const Row& row) {
  const auto role = TRY(row.word<Role>(2, "accounts.role"));
  const auto state = TRY(row.word<AccountState>(4, "accounts.state"));
  return Account{.id = row.text(0),
                 .name = row.text(1),
                 .role = role,
                 .password_hash = row.text(3),
                 .state = state,
                 .pseudonym = row.text(5),
                 .badge = row.text(6),
                 .pin_hash = row.text(7),
                 .totp_secret = row.text(8),
                 .totp_confirmed = row.truth(9),
                 .totp_step = row.integer(10),
                 .must_change = row.truth(11),
                 .made_utc_us = row.integer(12),
                 .level = row.text(13),
                 .language = row.text(14)};
}

/// Columns of kAccount and two times.
core::Result<Session> session_from(const Row& row) {
  auto account = TRY(account_from(row));
  return Session{std::move(account), row.integer(kAccountColumns),
                 row.integer(kAccountColumns + 1)};
}

/// The account whose `column` has this value.
core::Result<std::optional<Account>> account_by(Reading& tx, const char* column,
                                                const std::string& value) {
  return one_of(
      tx.query(std::string("select ") + kAccount + " from accounts a where a." + column + " = ?",
               {value}),
      account_from);
}

core::Result<std::string> station_text(Reading& tx, const std::string& column,
                                       const std::string& station_id) {
  auto rows = TRY(tx.query("select " + column + " from stations where id = ?", {station_id}));
  if (rows.empty()) return core::Error{core::Errc::not_found, "no such station"};
  return rows.front().text(0);
}

}  // namespace

core::Result<void> add_account(Writing& tx, const Account& account, std::int64_t now_utc_us) {
  auto done = run(
      tx,
      "insert into accounts (id, name, role, password_hash, made_utc_us, state, "
      "pseudonym, badge, pin_hash, must_change, level) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {account.id, account.name, name_value(account.role), account.password_hash, now_utc_us,
       name_value(account.state), text_or_null(account.pseudonym), text_or_null(account.badge),
       text_or_null(account.pin_hash), bool_value(account.must_change), account.level});
  if (!done && done.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict, "an account named " + account.name +
                                                 ", or one with this badge, exists already"};
  return done;
}

core::Result<void> set_account(Writing& tx, const Account& account) {
  auto done = run(tx,
                  "update accounts set role = ?, password_hash = ?, state = ?, badge = ?, "
                  "pin_hash = ?, totp_secret = ?, totp_confirmed = ?, totp_step = ?, "
                  "must_change = ?, level = ? where id = ?",
                  {name_value(account.role), account.password_hash, name_value(account.state),
                   text_or_null(account.badge), text_or_null(account.pin_hash),
                   text_or_null(account.totp_secret), bool_value(account.totp_confirmed),
                   account.totp_step, bool_value(account.must_change), account.level, account.id});
  if (!done && done.error().code == core::Errc::conflict)
    return core::Error{core::Errc::conflict, "badge: another account already has this badge"};
  return done;
}

core::Result<void> use_totp_step(Writing& tx, const std::string& account_id, std::int64_t step) {
  auto rows =
      TRY(tx.query("update accounts set totp_step = ? where id = ? and totp_step < ? returning id",
                   {step, account_id, step}));
  if (rows.empty())
    return core::Error{core::Errc::unauthorised, "the one-time code was already used"};
  return {};
}

core::Result<void> set_language(Writing& tx, const std::string& account_id,
                                const std::string& language) {
  return run(tx, "update accounts set language = ? where id = ?", {language, account_id});
}

core::Result<std::optional<Account>> account_named(Reading& tx, const std::string& name) {
  return account_by(tx, "name", name);
}

core::Result<std::optional<Account>> account_of(Reading& tx, const std::string& id) {
  return account_by(tx, "id", id);
}

core::Result<std::optional<Account>> account_with_badge(Reading& tx, const std::string& badge) {
  return account_by(tx, "badge", badge);
}

core::Result<std::vector<Account>> all_accounts(Reading& tx) {
  return all_of(tx.query(std::string("select ") + kAccount + " from accounts a order by a.name"),
                account_from);
}

const ListShape& account_list() {
  const OrderColumn key{"a.id"}, name{"a.name"};
  static const ListShape kShape{
      .from = "accounts a",
      .searched = "a.name || ' ' || coalesce(a.badge, '') || ' ' || a.level",
      .orders = {{"name", {name, key}},
                 {"role", {{"a.role"}, name, key}},
                 {"level", {{"a.level"}, name, key}},
                 {"made", {{"a.made_utc_us", ColumnType::integer}, key}, true}},
      .filters = {{"role", "Only accounts with this role", choices_of<Role>("a.role")},
                  {"state", "Only accounts in this state; a disabled account cannot sign in",
                   choices_of<AccountState>("a.state")}}};
  return kShape;
}

core::Result<FoundAccounts> find_accounts(Reading& tx, const ListRequest& request) {
  const std::string known = " and not exists (select 1 from erasures e where e.account_id = a.id)";
  auto found = TRY(find_keys(tx, account_list(), request, {.sql = known, .walked = known}));
  const SqlPart select{std::string("select ") + kAccount + " from accounts a where a.id in"};
  auto accounts = TRY(all_of(rows_of_keys(tx, select, found.keys), account_from));
  return FoundAccounts{std::move(accounts), std::move(found.page)};
}

core::Result<std::uint64_t> account_count(Reading& tx) {
  auto rows = TRY(tx.query("select count(*) from accounts"));
  return rows.front().count(0);
}

core::Result<void> add_session(Writing& tx, const std::string& token_hash,
                               const std::string& account_id, std::int64_t now_utc_us) {
  return run(tx,
             "insert into sessions (token_hash, account_id, made_utc_us, seen_utc_us) "
             "values (?, ?, ?, ?)",
             {token_hash, account_id, now_utc_us, now_utc_us});
}

core::Result<std::optional<Session>> session_of(Reading& tx, const std::string& token_hash) {
  return one_of(
      tx.query(std::string("select ") + kAccount +
                   ", s.made_utc_us, s.seen_utc_us "
                   "from sessions s join accounts a on a.id = s.account_id where s.token_hash = ?",
               {token_hash}),
      session_from);
}

core::Result<void> touch_session(Writing& tx, const std::string& token_hash,
                                 std::int64_t now_utc_us) {
  return run(tx, "update sessions set seen_utc_us = ? where token_hash = ?",
             {now_utc_us, token_hash});
}

core::Result<void> remove_session(Writing& tx, const std::string& token_hash) {
  return run(tx, "delete from sessions where token_hash = ?", {token_hash});
}

core::Result<void> remove_sessions_of(Writing& tx, const std::string& account_id,
                                      const std::string& but_token_hash) {
  return run(tx, "delete from sessions where account_id = ? and token_hash <> ?",
             {account_id, but_token_hash});
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
  auto rows =
      TRY(tx.query("select id, name from stations where token_hash = ? and revoked_utc_us is null",
                   {token_hash}));
  if (rows.empty()) return std::optional<Station>();
  return std::optional(Station{rows.front().text(0), rows.front().text(1)});
}

core::Result<std::vector<StationEntry>> all_stations(Reading& tx) {
  auto rows =
      TRY(tx.query("select id, name, enrolled_utc_us, revoked_utc_us from stations order by name"));
  std::vector<StationEntry> out;
  for (const Row& row : rows) {
    StationEntry entry{{row.text(0), row.text(1)}, row.integer(2), {}};
    if (const auto* at = std::get_if<std::int64_t>(&row.value(3))) entry.revoked_utc_us = *at;
    out.push_back(std::move(entry));
  }
  return out;
}

core::Result<void> revoke_station(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  auto rows = TRY(tx.query(
      "update stations set revoked_utc_us = coalesce(revoked_utc_us, ?) where id = ? returning id",
      {now_utc_us, id}));
  if (rows.empty()) return core::Error{core::Errc::not_found, "no such station"};
  return {};
}

core::Result<void> add_enrolment_code(Writing& tx, const std::string& code_hash,
                                      const std::string& station_name, std::int64_t now_utc_us,
                                      std::int64_t expires_utc_us) {
  auto rows = TRY(tx.query("select id from stations where name = ?", {station_name}));
  if (!rows.empty())
    return core::Error{core::Errc::conflict, "a station named " + station_name + " exists already"};
  return run(tx,
             "insert into enrolment_codes (code_hash, station_name, made_utc_us, expires_utc_us) "
             "values (?, ?, ?, ?)",
             {code_hash, station_name, now_utc_us, expires_utc_us});
}

core::Result<std::string> use_enrolment_code(Writing& tx, const std::string& code_hash,
                                             std::int64_t now_utc_us) {
  auto rows = TRY(tx.query(
      "update enrolment_codes set used_utc_us = ? where code_hash = ? and used_utc_us is null "
      "and expires_utc_us > ? returning station_name",
      {now_utc_us, code_hash, now_utc_us}));
  if (rows.empty())
    return core::Error{core::Errc::unauthorised, "this code is unknown, already used or expired"};
  return rows.front().text(0);
}

core::Result<std::string> station_token_hash(Reading& tx, const std::string& station_id) {
  return station_text(tx, "token_hash", station_id);
}

core::Result<std::string> station_name(Reading& tx, const std::string& station_id) {
  return station_text(tx, "name", station_id);
}

}  // namespace store
}  // namespace tractus
