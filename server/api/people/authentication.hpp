/// Who is it? Passwords, tokens and sessions.
#pragma once

#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "server/api/route.hpp"
#include "server/http/message.hpp"

namespace tractus::api {

inline constexpr const char* kSessionCookie = "tractus_session";
inline constexpr std::int64_t kSessionIdle_us = 2ll * 3600 * 1'000'000;
inline constexpr std::int64_t kSessionAge_us = 24ll * 3600 * 1'000'000;
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
/// where the account has them; notes failure or success for the throttle, makes a session. Ask
/// too_early first. Errors: unauthorised (see needs_code).
core::Result<SignedIn> sign_in(Backend& backend, const Credentials& given,
                               const store::Attempt& attempt);
/// Name and password were right, and a one-time code is asked for.
bool needs_code(const core::Error& error);
/// Takes as long for an unknown person as for a known one. @param hash  empty: of nobody
bool password_matches(const std::string& hash, const std::string& password);
/// Is the account's password, badge, PIN and state what it was when they were checked? A change
/// meanwhile ends sessions, and this one is not to begin after it. Errors: unauthorised.
core::Result<void> check_unchanged(store::Reading& tx, const store::Account& checked);
/// Uses a one-time code up. Errors: unauthorised.
core::Result<void> use_code(Backend& backend, store::Account& account, const std::string& code);
/// Closes the conversations (live views) of an account whose sessions were ended: those of this
/// process at once, others when they are next looked over (http::WebSocketHandler::kRecheck).
void close_conversations(Backend& backend, const std::string& account_id);

/// Does a request show that somebody is there? What a program asks by itself does not.
enum class Presence { shown, not_shown };
/// The caller by bearer token (a station) or cookie (a session that is neither idle nor old).
/// Errors: unauthorised.
core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head,
                                  Presence presence = Presence::shown);

}  // namespace tractus::api
