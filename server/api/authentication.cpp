#include "server/api/authentication.hpp"

#include <sodium.h>

#include "server/api/backend.hpp"

namespace api {
namespace {

constexpr std::int64_t kTouch_us = 60ll * 1'000'000;
constexpr const char* kThrottled = "too many failures to sign in: wait a quarter of an hour";

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

core::Result<Caller> by_token(Backend& backend, std::string_view token) {
  auto station = backend.store.read(
      [&](store::Reading& tx) { return store::station_of(tx, token_hash(token)); });
  if (!station) return station.error();
  if (!*station) return core::Error{core::Errc::unauthorised, "this token is not known"};
  return Caller{Role::station, (*station)->id, (*station)->name, ""};
}

core::Result<Caller> by_cookie(Backend& backend, std::string_view token) {
  const std::string hash = token_hash(token);
  auto session =
      backend.store.read([&](store::Reading& tx) { return store::session_of(tx, hash); });
  if (!session) return session.error();
  const std::int64_t now = backend.now_utc_us();
  const bool over = !*session || now - (*session)->seen_utc_us > kSessionIdle_us ||
                    now - (*session)->made_utc_us > kSessionAge_us;
  if (over) return core::Error{core::Errc::unauthorised, "sign in first: the session is over"};
  if (now - (*session)->seen_utc_us > kTouch_us) {
    auto touched = backend.store.write(
        [&](store::Writing& tx) { return store::touch_session(tx, hash, now); });
    if (!touched) return touched.error();
  }
  const store::Account& account = (*session)->account;
  if (account.role != name(Role::admin))
    return core::Error{core::Errc::unauthorised, "the account has no role known here"};
  return Caller{Role::admin, account.id, account.name, hash};
}

core::Result<void> check_throttle(Backend& backend, const std::string& name,
                                  const std::string& peer, std::int64_t since_utc_us) {
  auto failures = backend.store.read(
      [&](store::Reading& tx) { return store::login_failures(tx, name, peer, since_utc_us); });
  if (!failures) return failures.error();
  if (failures->from_peer >= kThrottleFailures || failures->for_name >= kThrottleNameFailures)
    return core::Error{core::Errc::unavailable, kThrottled};
  return {};
}

}  // namespace

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

bool is_throttled(const core::Error& error) {
  return error.code == core::Errc::unavailable && error.what == kThrottled;
}

core::Result<SignedIn> sign_in(Backend& backend, const std::string& name,
                               const std::string& password, const std::string& peer) {
  const std::int64_t now = backend.now_utc_us();
  const std::string& nobodys = nobodys_hash();  // made now, so that no later sign-in takes longer
  if (auto open = check_throttle(backend, name, peer, now - kThrottleWindow_us); !open)
    return open.error();
  auto account =
      backend.store.read([&](store::Reading& tx) { return store::account_named(tx, name); });
  if (!account) return account.error();
  const bool right = matches(*account ? (*account)->password_hash : nobodys, password);
  if (!*account || !right) {
    auto noted = backend.store.write([&](store::Writing& tx) {
      return store::add_login_failure(tx, name, peer, now, now - kThrottleWindow_us);
    });
    if (!noted) return noted.error();
    return core::Error{core::Errc::unauthorised, "name or password is wrong"};
  }
  const std::string token = new_token();
  auto made = backend.store.write([&](store::Writing& tx) -> core::Result<void> {
    if (auto done = store::clear_login_failures(tx, name, peer); !done) return done;
    if (auto done = store::remove_old_sessions(tx, now - kSessionIdle_us, now - kSessionAge_us);
        !done)
      return done;
    return store::add_session(tx, token_hash(token), (*account)->id, now);
  });
  if (!made) return made.error();
  return SignedIn{std::move(**account), token};
}

core::Result<Caller> authenticate(Backend& backend, const http::RequestHead& head) {
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view authorization = head.header("authorization");
  if (authorization.starts_with(kBearer))
    return by_token(backend, authorization.substr(kBearer.size()));
  if (const std::string_view cookie = head.cookie(kSessionCookie); !cookie.empty())
    return by_cookie(backend, cookie);
  return core::Error{core::Errc::unauthorised, "sign in first"};
}

}  // namespace api
