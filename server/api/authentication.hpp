/// Who is it? Passwords, tokens, sessions and the throttle.
#pragma once

#include "db/store/accounts.hpp"
#include "server/api/route.hpp"
#include "server/http/message.hpp"

namespace api {

inline constexpr const char* kSessionCookie = "tractus_session";
inline constexpr std::int64_t kSessionIdle_us = 2ll * 3600 * 1'000'000;
inline constexpr std::int64_t kSessionAge_us = 24ll * 3600 * 1'000'000;
inline constexpr std::int64_t kThrottleWindow_us = 15ll * 60 * 1'000'000;
inline constexpr std::uint64_t kThrottleFailures = 10;       ///< of one name from one address
inline constexpr std::uint64_t kThrottleNameFailures = 100;  ///< of one name from anywhere
inline constexpr std::size_t kMaxName = 128, kMaxPassword = 1024;

/// Argon2id at libsodium's interactive limits (64 MiB), as text with its salt. Errors: unavailable
/// (no memory).
core::Result<std::string> password_hash(const std::string& password);
/// 32 random bytes as 64 hexadecimal characters.
std::string new_token();
/// What is stored of a token. A stolen database opens no door; a plain hash is enough for what is
/// random.
std::string token_hash(std::string_view token);

struct Credentials {
  std::string name, password;
  std::string code = {};  ///< one-time, where the account asks for one
};
struct SignedIn {
  store::Account account;
  std::string token;  ///< for the cookie; nobody else keeps it
};
/// Checks name and password in the same time whether the name exists or not, then the one-time code
/// where the account has them; counts failures, makes a session. Errors: unauthorised (see
/// needs_code); Throttled (see is_throttled) after too many failures.
core::Result<SignedIn> sign_in(Backend& backend, const Credentials& given, const std::string& peer);
/// Name and password were right, and a one-time code is asked for.
bool needs_code(const core::Error& error);
/// Notes a failure of `name` from `peer` for the throttle, in a transaction of its own.
core::Result<void> note_failure(Backend& backend, const std::string& name, const std::string& peer);
/// Errors: Throttled when `name` failed too often.
core::Result<void> check_throttle(Backend& backend, const std::string& name,
                                  const std::string& peer,
                                  std::uint64_t most_from_peer = kThrottleFailures,
                                  std::uint64_t most_for_name = kThrottleNameFailures);
/// Takes as long for an unknown person as for a known one. @param hash  empty: of nobody
bool password_matches(const std::string& hash, const std::string& password);
/// Uses a one-time code up. Errors: unauthorised.
core::Result<void> use_code(Backend& backend, store::Account& account, const std::string& code);
/// The throttle's refusal, which HTTP calls 429.
bool is_throttled(const core::Error& error);

/// Does a request show that somebody is there? What a program asks by itself does not.
enum class Presence { shown, not_shown };
/// The caller by bearer token (a station) or cookie (a session that is neither idle nor old).
/// Errors: unauthorised.
core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head,
                                  Presence presence = Presence::shown);

}  // namespace api
