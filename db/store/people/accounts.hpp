/// Who may come in: accounts and their sessions for people, stations for machines.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Account {
  std::string id;
  std::string name;              ///< what is typed to sign in
  std::string role;              ///< "admin", "director", … as api::Role names them
  std::string password_hash;     ///< Argon2id, libsodium's text form
  std::string state = "active";  ///< "active", "disabled"
  std::string pseudonym = {};    ///< for research; the only place that joins it to the name
  std::string badge = {};        ///< what a station reads; empty: none
  std::string pin_hash = {};     ///< Argon2id; empty: no PIN
  std::string totp_secret = {};  ///< sealed; empty: no one-time codes
  bool totp_confirmed = false;   ///< a code was shown once: from now on one is asked for
  std::int64_t totp_step = 0;    ///< the last used, so that no code works twice
  bool must_change = false;      ///< the password was given by somebody else
  std::int64_t made_utc_us = 0;  ///< filled on reading
};

struct Session {
  Account account;
  std::int64_t made_utc_us = 0;
  std::int64_t seen_utc_us = 0;  ///< of the last request, to the minute
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
/// Puts everything but id, name, pseudonym and time in place. Errors: conflict when the badge is
/// taken.
core::Result<void> set_account(Writing& tx, const Account& account);
/// Errors: unauthorised when this step, or a later one, was used already: two requests with the
/// same one-time code cannot both succeed.
core::Result<void> use_totp_step(Writing& tx, const std::string& account_id, std::int64_t step);
core::Result<std::optional<Account>> account_named(Reading& tx, const std::string& name);
core::Result<std::optional<Account>> account_of(Reading& tx, const std::string& id);
core::Result<std::optional<Account>> account_with_badge(Reading& tx, const std::string& badge);
/// By name.
core::Result<std::vector<Account>> all_accounts(Reading& tx);
core::Result<std::uint64_t> account_count(Reading& tx);

/// @param token_hash  SHA-256 of the token the browser holds.
core::Result<void> add_session(Writing& tx, const std::string& token_hash,
                               const std::string& account_id, std::int64_t now_utc_us);
core::Result<std::optional<Session>> session_of(Reading& tx, const std::string& token_hash);
core::Result<void> touch_session(Writing& tx, const std::string& token_hash,
                                 std::int64_t now_utc_us);
core::Result<void> remove_session(Writing& tx, const std::string& token_hash);
/// All sessions of an account, but the one of this hash (empty: all).
core::Result<void> remove_sessions_of(Writing& tx, const std::string& account_id,
                                      const std::string& but_token_hash);
/// Removes sessions not seen since one time or made before another.
core::Result<void> remove_old_sessions(Writing& tx, std::int64_t unseen_since_utc_us,
                                       std::int64_t made_before_utc_us);

/// Errors: conflict when the name or the token is taken.
core::Result<void> add_station(Writing& tx, const Station& station, const std::string& token_hash,
                               std::int64_t now_utc_us);
/// Of stations that are not revoked.
core::Result<std::optional<Station>> station_of(Reading& tx, const std::string& token_hash);
/// By name.
core::Result<std::vector<StationEntry>> all_stations(Reading& tx);
/// Its token opens nothing from now on. Errors: not_found.
core::Result<void> revoke_station(Writing& tx, const std::string& id, std::int64_t now_utc_us);

/// A code for a station that is to come. Errors: conflict when a station has this name.
core::Result<void> add_enrolment_code(Writing& tx, const std::string& code_hash,
                                      const std::string& station_name, std::int64_t now_utc_us,
                                      std::int64_t expires_utc_us);
/// Uses a code up: the name of the station that it is for. Errors: unauthorised for one that is
/// unknown, used or too old, told alike.
core::Result<std::string> use_enrolment_code(Writing& tx, const std::string& code_hash,
                                             std::int64_t now_utc_us);

/// What is kept of a station's token. Errors: not_found.
core::Result<std::string> station_token_hash(Reading& tx, const std::string& station_id);
/// Errors: not_found.
core::Result<std::string> station_name(Reading& tx, const std::string& station_id);

}  // namespace tractus::store
