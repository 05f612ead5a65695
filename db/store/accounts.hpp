/// Who may come in: accounts and their sessions for people, stations for machines, and the failures
/// that throttle.
#pragma once

#include "db/store/store.hpp"

namespace store {

struct Account {
  std::string id;
  std::string name;           ///< what is typed to sign in
  std::string role;           ///< "admin"
  std::string password_hash;  ///< Argon2id, libsodium's text form
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

/// Errors: conflict when the name is taken.
core::Result<void> add_account(Writing& tx, const Account& account, std::int64_t now_utc_us);
core::Result<std::optional<Account>> account_named(Reading& tx, const std::string& name);
core::Result<std::uint64_t> account_count(Reading& tx);

/// @param token_hash  SHA-256 of the token the browser holds.
core::Result<void> add_session(Writing& tx, const std::string& token_hash,
                               const std::string& account_id, std::int64_t now_utc_us);
core::Result<std::optional<Session>> session_of(Reading& tx, const std::string& token_hash);
core::Result<void> touch_session(Writing& tx, const std::string& token_hash,
                                 std::int64_t now_utc_us);
core::Result<void> remove_session(Writing& tx, const std::string& token_hash);
/// Removes sessions not seen since one time or made before another.
core::Result<void> remove_old_sessions(Writing& tx, std::int64_t unseen_since_utc_us,
                                       std::int64_t made_before_utc_us);

/// Errors: conflict when the name is taken.
core::Result<void> add_station(Writing& tx, const Station& station, const std::string& token_hash,
                               std::int64_t now_utc_us);
core::Result<std::optional<Station>> station_of(Reading& tx, const std::string& token_hash);

/// What is kept of a station's token. Errors: not_found.
core::Result<std::string> station_token_hash(Reading& tx, const std::string& station_id);
/// Errors: not_found.
core::Result<std::string> station_name(Reading& tx, const std::string& station_id);

/// How often signing in failed since a time.
struct Failures {
  std::uint64_t from_peer = 0;  ///< for this name from this address
  std::uint64_t for_name = 0;   ///< for this name from anywhere
};
core::Result<Failures> login_failures(Reading& tx, const std::string& name, const std::string& peer,
                                      std::int64_t since_utc_us);
/// Notes one more, and forgets those before `forget_before_utc_us`.
core::Result<void> add_login_failure(Writing& tx, const std::string& name, const std::string& peer,
                                     std::int64_t now_utc_us, std::int64_t forget_before_utc_us);
core::Result<void> clear_login_failures(Writing& tx, const std::string& name,
                                        const std::string& peer);

}  // namespace store
