/// What people do with their own account: password and one-time codes. A session alone changes
/// neither: the password is asked for again, and a one-time code where the account has them.
#include <functional>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/owner_proof.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/totp.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMaxOwnAccount_bytes = 8192;
constexpr const char* kCodesAreOn = "one-time codes are already on: turn them off first";
constexpr std::size_t kTotpKey_bytes = 20;  // RFC 4226 section 4, R6: as long as SHA-1's output

http::Response done() { return {.status = 204, .headers = {}, .body = std::string()}; }

using Change = std::function<Result<void>(store::Writing&, store::Account&)>;

/// Changes the own account in one transaction and ends its other sessions.
Result<void> changed_own(const Call& call, const Change& change) {
  auto done = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = TRY(account_of_session(tx, call));
    TRY(change(tx, account));
    TRY(store::set_account(tx, account));
    TRY(store::clear_failures(tx, own_attempt_of(call)));
    return store::remove_sessions_of(tx, account.id, call.caller.session_hash);
  });
  if (done) close_conversations(call.backend, call.caller.id);
  return done;
}

/// Runs `change`; a wrong one-time code is counted as a failed attempt.
Result<http::Response> changed_by_code(const Call& call, const bool& wrong, const Change& change) {
  auto made = changed_own(call, change);
  if (wrong) TRY(note_failure(call.backend, own_attempt_of(call)));
  if (!made) return made.error();
  return done();
}

/// Runs `change` after refusal_of() returned nothing, and marks the one-time code as used.
Result<http::Response> changed_by_owner(const Call& call, const OwnerProof& proof,
                                        const Change& change) {
  bool wrong = false;
  return changed_by_code(call, wrong, [&](store::Writing& tx, store::Account& own) -> Result<void> {
    if (own.totp_confirmed) TRY(take_code(call, own, proof.code, wrong));
    return change(tx, own);
  });
}

Result<http::Response> change_password(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const OwnerProof proof{"old", fields.text("old", kMaxPassword), fields.text_or("code", "", 16)};
  const std::string after = password_field(fields, "new", true);
  if (proof.password == after)
    fields.wrong("new", "a password that differs from the current password is expected");
  TRY(fields.done());
  auto refusal = TRY(refusal_of(call, proof));
  if (refusal) return std::move(*refusal);
  auto hash = TRY(password_hash(after));
  return changed_by_owner(call, proof, [&](store::Writing&, store::Account& own) -> Result<void> {
    own.password_hash = hash;
    own.must_change = false;
    return {};
  });
}

Result<http::Response> begin_codes(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const OwnerProof proof{"password", fields.text("password", kMaxPassword), ""};
  TRY(fields.done());
  auto account =
      TRY(call.backend.store.read([&](store::Reading& tx) { return own_account(tx, call); }));
  if (account.totp_confirmed) return Error{Errc::conflict, kCodesAreOn};
  auto refusal = TRY(refusal_of(call, proof));
  if (refusal) return std::move(*refusal);
  const core::Bytes secret = core::random_bytes(kTotpKey_bytes);
  TRY(changed_own(call, [&](store::Writing&, store::Account& own) -> Result<void> {
    if (own.totp_confirmed) return Error{Errc::conflict, kCodesAreOn};
    own.totp_secret = call.backend.secrets.sealed(core::text_of(secret));
    return {};
  }));
  return json_response({{"secret", base32(secret)}, {"uri", totp_uri(secret, call.caller.name)}});
}

Result<http::Response> confirm_codes(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string code = fields.text("code", 16);
  TRY(fields.done());
  auto early = TRY(too_early(call.backend, own_attempt_of(call)));
  if (early) return std::move(*early);
  bool wrong = false;
  return changed_by_code(call, wrong, [&](store::Writing&, store::Account& own) -> Result<void> {
    if (own.totp_secret.empty() || own.totp_confirmed)
      return Error{Errc::conflict,
                   "there is no secret to confirm: call POST /api/v1/session/codes first"};
    TRY(take_code(call, own, code, wrong));
    own.totp_confirmed = true;
    return {};
  });
}

Result<http::Response> end_codes(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const OwnerProof proof{"password", fields.text("password", kMaxPassword),
                         fields.text("code", 16)};
  TRY(fields.done());
  auto refusal = TRY(refusal_of(call, proof));
  if (refusal) return std::move(*refusal);
  return changed_by_owner(call, proof, [](store::Writing&, store::Account& own) -> Result<void> {
    if (!own.totp_confirmed) return Error{Errc::conflict, "one-time codes are already off"};
    own.totp_confirmed = false;
    own.totp_secret.clear();
    return {};
  });
}

RouteInfo own_account_route(std::string method, std::string tail, std::string id,
                            std::string summary, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/session/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = people(),
          .parameters = {},
          .body = "",
          .body_limit_bytes = kMaxOwnAccount_bytes,
          .answer = "",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> own_account_routes() {
  using namespace schema;
  const core::Json code_where_asked =
      optional(text("One-time code of six digits; required if the account uses one-time codes"));
  RouteInfo password = own_account_route(
      "POST", "password", "changePassword",
      "Change the caller's password; this ends the caller's other sessions", change_password);
  password.before_password_change = true;
  password.lane = http::Lane::hashing;
  password.body = "PasswordChange";
  password.schemas = {
      {"PasswordChange",
       object({{"old", text("Current password")},
               {"new", text("New password, 12 to 1024 bytes, different from the current password")},
               {"code", code_where_asked}})}};
  RouteInfo begin =
      own_account_route("POST", "codes", "beginCodes",
                        "Create a secret for an authenticator app (RFC 6238); one-time codes are "
                        "required after the secret is confirmed",
                        begin_codes);
  begin.lane = http::Lane::hashing;
  begin.body = "PasswordShown";
  begin.answer = "CodesBegun";
  begin.schemas = {
      {"PasswordShown", object({{"password", text("Current password of the caller")}})},
      {"CodesBegun",
       object({{"secret", text("Secret in base32, shown only in this answer")},
               {"uri", text("otpauth:// address of the secret, to be shown as a QR code")}})}};
  RouteInfo confirm =
      own_account_route("POST", "codes/confirm", "confirmCodes",
                        "Confirm the secret with a one-time code; from then on signing in "
                        "requires a one-time code, and the caller's other sessions end",
                        confirm_codes);
  confirm.body = "OneTimeCode";
  confirm.schemas = {{"OneTimeCode", object({{"code", text("One-time code, six digits")}})}};
  RouteInfo end = own_account_route(
      "POST", "codes/end", "endCodes",
      "Turn one-time codes off; this ends the caller's other sessions", end_codes);
  end.lane = http::Lane::hashing;
  end.body = "PasswordAndCode";
  end.schemas = {{"PasswordAndCode", object({{"password", text("Current password of the caller")},
                                             {"code", text("One-time code, six digits")}})}};
  return {password, begin, confirm, end};
}

}  // namespace api
}  // namespace tractus
