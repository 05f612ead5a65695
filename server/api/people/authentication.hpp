/// Authentication by passwords, tokens and sessions.
#pragma once

#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "server/api/route.hpp"
#include "server/http/message.hpp"

namespace tractus::api {

inline constexpr const char* kSessionCookie = "tractus_session";
inline constexpr const char* kApiTokenPrefix = "tractus_";
inline constexpr std::int64_t kSessionIdle_us = 2ll * 3600 * 1'000'000;
inline constexpr std::int64_t kSessionAge_us = 24ll * 3600 * 1'000'000;
inline constexpr std::size_t kMaxName = 128, kMaxPassword = 1024;

/// Argon2id at libsodium's interactive limits (64 MiB), as text with its salt. Errors: unavailable
/// (no memory).
core::Result<std::string> password_hash(const std::string& password);
/// 32 random bytes as 64 hexadecimal characters.
std::string new_token();
/// The hash of a token that the database stores, so that a stolen database contains no valid
/// tokens. An unsalted hash is sufficient because tokens are random.
std::string token_hash(std::string_view token);
/// The session's cookie, as Set-Cookie takes it. @param token  empty: removes the cookie
std::string session_cookie(const Backend& backend, const std::string& token);

struct Credentials {
  std::string name, password;
  std::string code = {};  ///< one-time code, if the account uses one-time codes
};
struct SignedIn {
  store::Account account;
  std::string token;  ///< session token for the cookie; the server stores only its hash
};
/// Checks name and password, in the same time whether the name exists or not, then the one-time
/// code if the account uses them; records failure or success for the throttle, and creates a
/// session. Call too_early() first. Errors: unauthorised (see needs_code).
core::Result<SignedIn> sign_in(Backend& backend, const Credentials& given,
                               const store::Attempt& attempt);
/// Whether name and password were correct, but a one-time code is required.
bool needs_code(const core::Error& error);
/// Takes the same time for an unknown person as for a known one. @param hash  empty: unknown person
bool password_matches(const std::string& hash, const std::string& password);
/// Checks that password, badge, PIN and state of the account are unchanged since they were checked.
/// A change ends all sessions, and no session may start afterwards with the old credentials.
/// Errors: unauthorised.
core::Result<void> check_unchanged(store::Reading& tx, const store::Account& checked);
/// Checks a one-time code and marks it as used. Errors: unauthorised.
core::Result<void> use_code(Backend& backend, store::Account& account, const std::string& code);
/// Closes the WebSockets (live pages) of an account whose sessions were ended: those of this
/// process immediately, those of other processes at the next check
/// (http::WebSocketHandler::kRecheck).
void close_conversations(Backend& backend, const std::string& account_id);

/// Whether a request shows that a person is active. Periodic requests of a page do not.
enum class Presence { shown, not_shown };
/// The caller with this bearer token (a station, or a person's API token) or this cookie (a session
/// that is not expired). Errors: unauthorised (see is_throttled); bad_input for a bearer token and a
/// session's cookie together.
core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head,
                                  Presence presence = Presence::shown);

/// Whether unknown API tokens came too often from the caller's network: the answer is then 429 with
/// Retry-After, in seconds. Valid tokens from there are served.
bool is_throttled(const core::Error& error);
inline constexpr int kTokenRetry_s = 20;

}  // namespace tractus::api
