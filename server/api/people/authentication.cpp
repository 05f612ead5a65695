#include "server/api/people/authentication.hpp"

#include <sodium.h>

#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/api_tokens.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/totp.hpp"
#include "server/live/hub.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::int64_t kTouch_us = 60ll * 1'000'000;
constexpr const char* kCodeNeeded = "a one-time code is required";
constexpr const char* kTooManyTokens = "too many unknown API tokens came from this network";

bool matches(const std::string& hash, const std::string& password) {
  return crypto_pwhash_str_verify(hash.c_str(), password.data(), password.size()) == 0;
}

/// The hash of a password nobody has: what an unknown name is checked against, so that it takes as
/// long as a known one.
const std::string& nobodys_hash() {
  static const std::string hash = [] {
    auto made = password_hash(new_token());
    core::require(bool(made), "64 MiB for a password's hash can be had at the start");
    return *made;
  }();
  return hash;
}

/// An unknown token is a guess; the throttle counts it against the network that it came from.
core::Result<Caller> refused_api_token(Backend& backend, const std::string& peer) {
  const store::Attempt attempt{store::Secret::api_token, "", network_of(peer)};
  const auto early = TRY(too_early(backend, attempt));
  if (early) return core::Error{core::Errc::unauthorised, kTooManyTokens};
  TRY(note_failure(backend, attempt));
  return core::Error{core::Errc::unauthorised, "this API token is unknown"};
}

struct TokenHolder {
  store::ApiToken token;
  store::Account account;
};

core::Result<std::optional<TokenHolder>> holder_of(Backend& backend, std::string_view token) {
  using Found = std::optional<TokenHolder>;
  return backend.store.read([&](store::Reading& tx) -> core::Result<Found> {
    auto found = TRY(store::api_token_with(tx, token_hash(token)));
    if (!found) return Found();
    auto account = TRY(store::account_of(tx, found->account_id));
    core::require(account.has_value(), "an API token has an account");
    return Found(TokenHolder{std::move(*found), std::move(*account)});
  });
}

core::Result<Caller> by_api_token(Backend& backend, std::string_view text,
                                  const std::string& peer) {
  auto holder = TRY(holder_of(backend, text));
  if (!holder) return refused_api_token(backend, peer);
  const auto& [token, account] = *holder;
  const std::int64_t now = backend.now_utc_us();
  if (!store::is_valid(token, now))
    return core::Error{core::Errc::unauthorised,
                       token.revoked_utc_us ? "this API token was revoked: make a new one"
                                            : "this API token has expired: make a new one"};
  if (account.role == Role::station || account.state != store::AccountState::active)
    return core::Error{core::Errc::unauthorised, "the account is disabled"};
  if (now - token.used_utc_us.value_or(0) > kTouch_us) {
    TRY(backend.store.write_beside(
        [&](store::Writing& tx) { return store::note_api_token_use(tx, token.id, now); }));
  }
  return Caller{.role = account.role,
                .id = account.id,
                .name = account.name,
                .session_hash = {},
                .must_change = account.must_change,
                .token = TokenUse{token.id, token.scopes},
                .language = account.language};
}

core::Result<Caller> by_token(Backend& backend, std::string_view token, const std::string& peer) {
  if (token.starts_with(kApiTokenPrefix)) return by_api_token(backend, token, peer);
  auto station = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::station_of(tx, token_hash(token)); }));
  if (!station) return core::Error{core::Errc::unauthorised, "this token is unknown"};
  return Caller{Role::station, station->id, station->name, ""};
}

core::Result<Caller> by_cookie(Backend& backend, std::string_view token, Presence presence) {
  const std::string hash = token_hash(token);
  auto session =
      TRY(backend.store.read([&](store::Reading& tx) { return store::session_of(tx, hash); }));
  const std::int64_t now = backend.now_utc_us();
  const bool over = !session || now - session->seen_utc_us > kSessionIdle_us ||
                    now - session->made_utc_us > kSessionAge_us;
  if (over) return core::Error{core::Errc::unauthorised, "the session has ended: sign in again"};
  if (presence == Presence::shown && now - session->seen_utc_us > kTouch_us) {
    TRY(backend.store.write_beside(
        [&](store::Writing& tx) { return store::touch_session(tx, hash, now); }));
  }
  const store::Account& account = session->account;
  if (account.role == Role::station || account.state != store::AccountState::active)
    return core::Error{core::Errc::unauthorised, "the account is disabled"};
  return Caller{.role = account.role,
                .id = account.id,
                .name = account.name,
                .session_hash = hash,
                .must_change = account.must_change,
                .language = account.language};
}

}  // namespace

bool password_matches(const std::string& hash, const std::string& password) {
  const std::string& nobodys = nobodys_hash();  // made now, so that no later check takes longer
  return matches(hash.empty() ? nobodys : hash, password) && !hash.empty();
}

core::Result<void> check_unchanged(store::Reading& tx, const store::Account& checked) {
  auto now = TRY(store::account_of(tx, checked.id));
  if (now && now->password_hash == checked.password_hash && now->badge == checked.badge &&
      now->pin_hash == checked.pin_hash && now->state == checked.state)
    return {};
  return core::Error{core::Errc::unauthorised, "the account was changed just now: try again"};
}

core::Result<void> use_code(Backend& backend, store::Account& account, const std::string& code) {
  auto secret = TRY(backend.secrets.opened(account.totp_secret));
  const auto step =
      totp_step(core::bytes_of(secret), code, backend.now_utc_us(), account.totp_step);
  if (!step) return core::Error{core::Errc::unauthorised, "the one-time code is wrong"};
  account.totp_step = *step;
  return {};
}

bool needs_code(const core::Error& error) {
  return error.code == core::Errc::unauthorised && error.what == kCodeNeeded;
}

bool is_throttled(const core::Error& error) {
  return error.code == core::Errc::unauthorised && error.what == kTooManyTokens;
}

core::Result<std::string> password_hash(const std::string& password) {
  core::require(sodium_init() >= 0, "libsodium starts");
  std::string out(crypto_pwhash_STRBYTES, '\0');
  if (crypto_pwhash_str(out.data(), password.data(), password.size(),
                        crypto_pwhash_OPSLIMIT_INTERACTIVE,
                        crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0)
    return core::Error{core::Errc::unavailable, "no memory to hash a password"};
  out.resize(out.find('\0'));
  return out;
}

std::string new_token() { return core::hex(core::random_bytes(32)); }

std::string token_hash(std::string_view token) { return core::sha256(core::bytes_of(token)); }

std::string session_cookie(const Backend& backend, const std::string& token) {
  const std::int64_t age_s = token.empty() ? 0 : kSessionAge_us / 1'000'000;
  return std::string(kSessionCookie) + "=" + token +
         "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" + std::to_string(age_s) +
         (backend.secure_cookies ? "; Secure" : "");
}

namespace {

/// The account that these credentials open, its one-time code used up.
core::Result<store::Account> account_opened(Backend& backend, const Credentials& given) {
  auto account = TRY(
      backend.store.read([&](store::Reading& tx) { return store::account_named(tx, given.name); }));
  const bool right = password_matches(account ? account->password_hash : "", given.password);
  if (!account) store::AuditScope::without_detail();
  if (!account || !right || account->state != store::AccountState::active)
    return core::Error{core::Errc::unauthorised, "name or password is wrong"};
  if (!account->totp_confirmed) return std::move(*account);
  if (given.code.empty()) return core::Error{core::Errc::unauthorised, kCodeNeeded};
  TRY(use_code(backend, *account, given.code));
  return std::move(*account);
}

}  // namespace

core::Result<SignedIn> sign_in(Backend& backend, const Credentials& given,
                               const store::Attempt& attempt) {
  auto account = account_opened(backend, given);
  if (!account) {
    if (account.error().code != core::Errc::unauthorised || needs_code(account.error()))
      return account.error();
    TRY(note_failure(backend, attempt));
    return account.error();
  }
  store::AuditScope::is_by(account->name, name(account->role));
  const std::int64_t now = backend.now_utc_us();
  const std::string token = new_token();
  TRY(backend.store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(check_unchanged(tx, *account));
    TRY(note_success(tx, account->id, attempt, now));
    TRY(store::remove_old_sessions(tx, now - kSessionIdle_us, now - kSessionAge_us));
    if (account->totp_confirmed) TRY(store::use_totp_step(tx, account->id, account->totp_step));
    return store::add_session(tx, token_hash(token), account->id, now);
  }));
  return SignedIn{std::move(*account), token};
}

void close_conversations(Backend& backend, const std::string& account_id) {
  if (backend.live) backend.live->dismiss_viewers(account_id);
}

core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head,
                                  Presence presence) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view authorization = head.header("authorization");
  const std::string_view cookie = head.cookie(kSessionCookie);
  if (authorization.starts_with(kBearer)) {
    if (!cookie.empty())
      return core::Error{core::Errc::bad_input,
                         "the request has a token and a session cookie: send one of them"};
    return by_token(backend, authorization.substr(kBearer.size()), head.peer);
  }
  if (!cookie.empty()) return by_cookie(backend, cookie, presence);
  return core::Error{core::Errc::unauthorised, "sign in first"};
}

}  // namespace api
}  // namespace tractus
