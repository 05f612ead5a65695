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

struct SignedIn {
  store::Account account;
  std::string token;  ///< for the cookie; nobody else keeps it
};
/// Checks name and password in the same time whether the name exists or not, counts failures, makes
/// a session. Errors: unauthorised; Throttled (see is_throttled) after too many failures.
core::Result<SignedIn> sign_in(Backend& backend, const std::string& name,
                               const std::string& password, const std::string& peer);
/// The throttle's refusal, which HTTP calls 429.
bool is_throttled(const core::Error& error);

/// The caller by bearer token (a station) or cookie (a session that is neither idle nor old).
/// Errors: unauthorised.
core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head);

}  // namespace api
