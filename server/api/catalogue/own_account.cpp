/// What people do with their own account: password and one-time codes.
#include "server/api/authentication.hpp"
#include "server/api/backend.hpp"
#include "server/api/people_json.hpp"
#include "server/api/schema.hpp"
#include "server/api/totp.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMaxBody_bytes = 8192;
constexpr std::size_t kTotpKey_bytes = 20;  // RFC 4226 section 4, R6: as long as SHA-1's output

Result<store::Account> own_account(store::Reading& tx, const Call& call) {
  auto account = store::account_of(tx, call.caller.id);
  if (!account) return account.error();
  core::require(account->has_value(), "who is signed in has an account");
  return std::move(**account);
}

http::Response done() { return {.status = 204, .headers = {}, .body = std::string()}; }

Result<http::Response> change_password(const Call& call) {
  auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "body");
  const std::string before = fields.text("old", kMaxPassword);
  const std::string after = password_field(fields, "new", true);
  if (before == after) fields.wrong("new", "another password than before is expected");
  if (auto fine = fields.done(); !fine) return fine.error();
  const std::string &name = call.caller.name, &peer = call.request.peer;
  if (auto open = check_throttle(call.backend, name, peer); !open) return open.error();
  auto account = call.backend.store.read([&](store::Reading& tx) { return own_account(tx, call); });
  if (!account) return account.error();
  if (!password_matches(account->password_hash, before)) {
    if (auto noted = note_failure(call.backend, name, peer); !noted) return noted.error();
    return Error{Errc::forbidden, "body: /old: is not the password"};
  }
  auto hash = password_hash(after);
  if (!hash) return hash.error();
  auto changed = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto now = own_account(tx, call);
    if (!now) return now.error();
    now->password_hash = *hash;
    now->must_change = false;
    if (auto set = store::set_account(tx, *now); !set) return set;
    return store::remove_sessions_of(tx, now->id, call.caller.session_hash);
  });
  if (!changed) return changed.error();
  return done();
}

Result<http::Response> begin_codes(const Call& call) {
  const core::Bytes secret = core::random_bytes(kTotpKey_bytes);
  auto begun = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = own_account(tx, call);
    if (!account) return account.error();
    if (account->totp_confirmed)
      return Error{Errc::conflict, "one-time codes are asked for already: end them first"};
    account->totp_secret = call.backend.secrets.sealed(core::text_of(secret));
    return store::set_account(tx, *account);
  });
  if (!begun) return begun.error();
  return json_response({{"secret", base32(secret)}, {"uri", totp_uri(secret, call.caller.name)}});
}

Result<std::string> code_of(const Call& call) {
  auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "body");
  std::string code = fields.text("code", 16);
  if (auto fine = fields.done(); !fine) return fine.error();
  return code;
}

/// Checks the code of the body and leaves the codes on or off.
Result<http::Response> with_code(const Call& call, bool on) {
  auto code = code_of(call);
  if (!code) return code.error();
  const std::string &name = call.caller.name, &peer = call.request.peer;
  if (auto open = check_throttle(call.backend, name, peer); !open) return open.error();
  bool wrong = false;
  auto set = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = own_account(tx, call);
    if (!account) return account.error();
    if (account->totp_secret.empty() || account->totp_confirmed == on)
      return Error{Errc::conflict, on ? "ask for a secret first" : "no codes are asked for"};
    auto used = use_code(call.backend, *account, *code);
    wrong = !used;
    if (!used) return Error{Errc::forbidden, "body: /code: is wrong"};
    account->totp_confirmed = on;
    if (!on) account->totp_secret.clear();
    return store::set_account(tx, *account);
  });
  if (wrong)
    if (auto noted = note_failure(call.backend, name, peer); !noted) return noted.error();
  if (!set) return set.error();
  return done();
}

Result<http::Response> confirm_codes(const Call& call) { return with_code(call, true); }
Result<http::Response> end_codes(const Call& call) { return with_code(call, false); }

RouteInfo route(std::string method, std::string tail, std::string id, std::string summary,
                Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/session/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = people(),
          .parameters = {},
          .body = "",
          .body_limit_bytes = kMaxBody_bytes,
          .answer = "",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> own_account_routes() {
  using namespace schema;
  RouteInfo password = route("POST", "password", "changePassword",
                             "Choose another password; the other sessions end", change_password);
  password.before_password_change = true;
  password.body = "PasswordChange";
  password.schemas = {{"PasswordChange", object({{"old", text("the password until now")},
                                                 {"new", text("12 to 1024 bytes")}})}};
  RouteInfo begin =
      route("POST", "codes", "beginCodes",
            "A secret for an authenticator (RFC 6238); asked for once confirmed", begin_codes);
  begin.answer = "CodesBegun";
  begin.schemas = {{"CodesBegun", object({{"secret", text("base32, shown only now")},
                                          {"uri", text("otpauth://…, to scan")}})}};
  RouteInfo confirm =
      route("POST", "codes/confirm", "confirmCodes",
            "From now on a one-time code is asked for at signing in", confirm_codes);
  confirm.body = "OneTimeCode";
  confirm.schemas = {{"OneTimeCode", object({{"code", text("six digits")}})}};
  RouteInfo end =
      route("POST", "codes/end", "endCodes", "No longer ask for one-time codes", end_codes);
  end.body = "OneTimeCode";
  return {password, begin, confirm, end};
}

}  // namespace api
