/// Accounts and sessions of people, and stations.
#pragma once

#include <vector>

#include "db/store/finding/list.hpp"
#include "db/store/people/role.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

enum class AccountState {
  active,
  disabled,  ///< cannot sign in
};
constexpr auto words(AccountState) {
  return std::to_array<core::Word<AccountState>>(
      {{AccountState::active, "active"}, {AccountState::disabled, "disabled"}});
}

struct Account {
  std::string id;
  std::string name;  ///< name with which the person signs in
  Role role = Role::trainee;
  std::string password_hash;  ///< Argon2id, libsodium's text form
  AccountState state = AccountState::active;
  std::string pseudonym = {};    ///< pseudonym for research; only this row links it to the name
  std::string badge = {};        ///< text that a station reads from the badge; empty: no badge
  std::string pin_hash = {};     ///< Argon2id; empty: no PIN
  std::string totp_secret = {};  ///< encrypted; empty: no one-time codes
  bool totp_confirmed = false;   ///< confirmed: signing in requires a one-time code
  std::int64_t totp_step = 0;  ///< time step of the last used code, so that no code is valid twice
  bool must_change = false;    ///< another person set the password: the owner must change it first
  std::int64_t made_utc_us = 0;  ///< filled on reading
  std::string level = {};        ///< of training, in the programme's words: "PGY-2"
  std::string language = {};     ///< of pages and e-mails: "de"; empty: not chosen
};

struct Session {
  Account account;
  std::int64_t made_utc_us = 0;
  std::int64_t seen_utc_us = 0;  ///< time of the last request, to the minute
};

struct Station {
  std::string id;
  std::string name;
};

/// A station as the fleet's list shows it.
struct StationEntry {
  Station station;
  std::int64_t enrolled_utc_us = 0;
  std::optional<std::int64_t> revoked_utc_us = {};
};

/// Errors: conflict when the name, the badge or the pseudonym is taken.
core::Result<void> add_account(Writing& tx, const Account& account, std::int64_t now_utc_us);
/// Updates all fields except id, name, pseudonym, language and time. Errors: conflict if another account has
/// the badge.
core::Result<void> set_account(Writing& tx, const Account& account);
/// Errors: unauthorised when this step, or a later one, was used already: two requests with the
/// same one-time code cannot both succeed.
core::Result<void> use_totp_step(Writing& tx, const std::string& account_id, std::int64_t step);
core::Result<void> set_language(Writing& tx, const std::string& account_id,
                                const std::string& language);
core::Result<std::optional<Account>> account_named(Reading& tx, const std::string& name);
core::Result<std::optional<Account>> account_of(Reading& tx, const std::string& id);
core::Result<std::optional<Account>> account_with_badge(Reading& tx, const std::string& badge);
/// By name.
core::Result<std::vector<Account>> all_accounts(Reading& tx);
/// The list of accounts (finding/list.hpp): its orders and filters.
const ListShape& account_list();
struct FoundAccounts {
  std::vector<Account> accounts;
  ListPage page;
};
core::Result<FoundAccounts> find_accounts(Reading& tx, const ListRequest& request);
core::Result<std::uint64_t> account_count(Reading& tx);

/// @param token_hash  SHA-256 of the token the browser holds.
core::Result<void> add_session(Writing& tx, const std::string& token_hash,
                               const std::string& account_id, std::int64_t now_utc_us);
core::Result<std::optional<Session>> session_of(Reading& tx, const std::string& token_hash);
core::Result<void> touch_session(Writing& tx, const std::string& token_hash,
                                 std::int64_t now_utc_us);
core::Result<void> remove_session(Writing& tx, const std::string& token_hash);
/// Removes all sessions of an account except the one with this hash (empty: all).
core::Result<void> remove_sessions_of(Writing& tx, const std::string& account_id,
                                      const std::string& but_token_hash);
/// Removes sessions that are idle since one time or older than another.
core::Result<void> remove_old_sessions(Writing& tx, std::int64_t unseen_since_utc_us,
                                       std::int64_t made_before_utc_us);

/// Errors: conflict when the name or the token is taken.
core::Result<void> add_station(Writing& tx, const Station& station, const std::string& token_hash,
                               std::int64_t now_utc_us);
/// Of stations that are not revoked.
core::Result<std::optional<Station>> station_of(Reading& tx, const std::string& token_hash);
/// By name.
core::Result<std::vector<StationEntry>> all_stations(Reading& tx);
/// Revokes the station: its token becomes invalid. Errors: not_found.
core::Result<void> revoke_station(Writing& tx, const std::string& id, std::int64_t now_utc_us);

/// Adds an enrolment code for a new station. Errors: conflict if a station has this name.
core::Result<void> add_enrolment_code(Writing& tx, const std::string& code_hash,
                                      const std::string& station_name, std::int64_t now_utc_us,
                                      std::int64_t expires_utc_us);
/// Uses an enrolment code and returns the name of the new station. Errors: unauthorised, with the
/// same message for an unknown, a used and an expired code.
core::Result<std::string> use_enrolment_code(Writing& tx, const std::string& code_hash,
                                             std::int64_t now_utc_us);

/// The stored hash of a station's token. Errors: not_found.
core::Result<std::string> station_token_hash(Reading& tx, const std::string& station_id);
/// Errors: not_found.
core::Result<std::string> station_name(Reading& tx, const std::string& station_id);

}  // namespace tractus::store
