/// Signing in by a provider of identities. Whom it vouches for gets no account by that: an
/// administrator says which one is whose, or writes a rule of the provider's groups.
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/subjects.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/group_admission.hpp"
#include "server/api/people/oidc.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr const char* kAttemptCookie = "tractus_oidc";
constexpr std::int64_t kAttempt_us = 10ll * 60 * 1'000'000;

/// Cookie of one sign-in attempt. SameSite=Lax, because the browser returns from another site.
std::string attempt_cookie(const Backend& backend, const std::string& value, std::int64_t seconds) {
  return std::string(kAttemptCookie) + "=" + value +
         "; Path=/api/v1/session/oidc; HttpOnly; SameSite=Lax; Max-Age=" + std::to_string(seconds) +
         (backend.secure_cookies ? "; Secure" : "");
}

Result<const Oidc*> provider(const Call& call) {
  if (call.backend.oidc) return call.backend.oidc;
  return Error{Errc::not_found, "this server has no OpenID Connect provider"};
}

/// Redirects to the web pages, which show that the sign-in failed.
http::Response failed(const Call& call, const Error& why) {
  if (call.backend.log) call.backend.log({{"what", "oidc"}, {"refused", why.what}});
  return redirection("/?sign_in=failed");
}

Result<http::Response> offered(const Call& call) {
  const Oidc* oidc = call.backend.oidc;
  return json_response(
      {{"offered", oidc != nullptr}, {"label", oidc ? Json(oidc->settings().label) : Json()}});
}

Result<http::Response> begin(const Call& call) {
  const auto oidc = TRY(provider(call));
  const OidcAttempt attempt = new_attempt();
  auto address = oidc->sign_in_address(attempt);
  if (!address) return failed(call, address.error());
  const Json kept{{"state", attempt.state},
                  {"nonce", attempt.nonce},
                  {"verifier", attempt.verifier},
                  {"until_utc_us", call.backend.now_utc_us() + kAttempt_us}};
  auto out = redirection(*address);
  out.with("Set-Cookie", attempt_cookie(call.backend, call.backend.secrets.sealed(kept.dump()),
                                        kAttempt_us / 1'000'000));
  return out;
}

/// The sign-in attempt that this browser began, if the request answers that attempt.
Result<OidcAttempt> attempt_of(const Call& call) {
  const Error none{Errc::unauthorised,
                   "this browser did not begin this sign-in, or began it too long ago"};
  const std::string sealed(call.request.cookie(kAttemptCookie));
  if (sealed.empty()) return none;
  const auto opened = call.backend.secrets.opened(sealed);
  if (!opened) return none;
  const Json json = core::stored_json(*opened);
  if (!json.is_object() || call.backend.now_utc_us() > json.value("until_utc_us", std::int64_t{0}))
    return none;
  OidcAttempt out{json.value("state", ""), json.value("nonce", ""), json.value("verifier", "")};
  if (out.state.empty() || out.state != call.text("state")) return none;
  return out;
}

/// What the administrators' rule says of this person is done before anybody is let in.
Result<void> apply_groups(const Call& call, const Oidc& oidc, const Identity& identity) {
  const auto rule =
      TRY(call.backend.store.read([](store::Reading& tx) { return current_group_rule(tx); }));
  if (!rule) return {};
  const std::int64_t now = call.backend.now_utc_us();
  const store::AuditScope acting(
      {.who = identity.name.empty() ? "a person of the provider" : identity.name,
       .role = "",
       .peer = call.request.peer,
       .what = "admitByGroups",
       .detail = Json{{"subject", identity.subject}, {"groups", identity.groups}}.dump(
           -1, ' ', false, Json::error_handler_t::replace),
       .at_utc_us = now});
  return call.backend.store.write([&](store::Writing& tx) {
    return admit_by_groups(tx, {oidc.settings().issuer, identity, now});
  });
}

/// Starts a session and returns its token. Errors: unauthorised if no active account has the
/// subject.
Result<std::string> session_for(const Call& call, const Oidc& oidc, const Identity& identity) {
  const std::string& subject = identity.subject;
  TRY(apply_groups(call, oidc, identity));
  auto account = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::account_of_subject(tx, oidc.settings().issuer, subject);
  }));
  if (!account || account->state != store::AccountState::active) {
    note_stranger(call.backend, call.request.peer, "oidcCallback",
                  {{"why", "no account has this subject"}, {"subject", subject}});
    return Error{Errc::unauthorised, "no account here is linked with this identity"};
  }
  const std::string token = new_token();
  const store::AuditScope acting({.who = account->name,
                                  .role = std::string(name(account->role)),
                                  .peer = call.request.peer,
                                  .what = "oidcSignIn",
                                  .at_utc_us = call.backend.now_utc_us()});
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto linked = TRY(store::account_of_subject(tx, oidc.settings().issuer, subject));
    if (!linked || linked->id != account->id || linked->state != store::AccountState::active)
      return Error{Errc::unauthorised, "the account was changed just now: try again"};
    return store::add_session(tx, token_hash(token), account->id, call.backend.now_utc_us());
  }));
  return token;
}

Result<std::string> signed_in(const Call& call, const Oidc& oidc) {
  if (call.has("error") || !call.has("code"))
    return Error{Errc::unauthorised, "the provider did not sign the person in"};
  if (call.has("iss") && call.text("iss") != oidc.settings().issuer)  // RFC 9207
    return Error{Errc::unauthorised, "this is another provider's answer"};
  const auto attempt = TRY(attempt_of(call));
  const auto identity =
      TRY(oidc.redeemed(call.text("code"), attempt, call.backend.now_utc_us() / 1'000'000));
  return session_for(call, oidc, identity);
}

/// Redirects the browser to the web pages in any case; they show what happened.
Result<http::Response> come_back(const Call& call) {
  const auto oidc = TRY(provider(call));
  const auto token = signed_in(call, *oidc);
  if (!token && call.backend.log)
    call.backend.log({{"what", "oidc"}, {"refused", token.error().what}});
  const bool unknown = !token && token.error().what.starts_with("no account");
  auto out = redirection(token ? "/" : unknown ? "/?sign_in=unknown" : "/?sign_in=failed");
  out.with("Set-Cookie", attempt_cookie(call.backend, "", 0));
  if (token) out.with("Set-Cookie", session_cookie(call.backend, *token));
  return out;
}

Result<http::Response> leave(const Call& call) {
  const auto oidc = TRY(provider(call));
  const auto address = oidc->sign_out_address();
  if (!address) return failed(call, address.error());
  return redirection(address->empty() ? "/" : *address);
}

Result<http::Response> link(const Call& call) {
  const auto oidc = TRY(provider(call));
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string subject = fields.text_or("subject", "", 255);
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = TRY(account_of_call(tx, call));
    TRY(store::link_subject(tx, {oidc->settings().issuer, subject, account.id,
                                 call.backend.now_utc_us(), call.caller.name}));
    return store::remove_sessions_of(tx, account.id, "");
  }));
  close_conversations(call.backend, call.text("id"));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

Parameter answered(std::string name, std::string meaning) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = false,
          .fallback = std::nullopt};
}

RouteInfo open_route(std::string tail, std::string id, std::string summary, std::string answer,
                     http::Lane lane, Result<http::Response> (*handle)(const Call&)) {
  return {.method = "GET",
          .path = "/api/v1/session/oidc" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {},
          .open = true,
          .lane = lane,
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> oidc_routes() {
  using namespace schema;
  RouteInfo offer = open_route("", "oidcOffered",
                               "Show whether people can sign in with an OpenID Connect provider",
                               "OidcOffer", http::Lane::quick, offered);
  offer.schemas = {
      {"OidcOffer",
       object({{"offered", truth("True if the server is configured with a provider")},
               {"label",
                nullable(text("Label of the sign-in button; null if there is no provider"))}})}};
  RouteInfo back =
      open_route("/callback", "oidcCallback",
                 "Redirect target to which the provider returns the browser after sign-in", kBytes,
                 http::Lane::remote, come_back);
  back.parameters = {
      answered("code", "Authorization code, which the server exchanges for an ID token"),
      answered("state", "State value of this sign-in attempt"),
      answered("iss", "Issuer identifier of the provider (RFC 9207)"),
      answered("error", "Error code of the provider, if the sign-in failed"),
      answered("error_description", "Description of the error in words"),
      answered("error_uri", "Address of a page that explains the error"),
      answered("session_state", "Session state of the provider; the server does not use it"),
      answered("scope", "Scopes that the provider granted")};
  RouteInfo join{
      .method = "POST",
      .path = "/api/v1/accounts/{id}/subject",
      .id = "linkSubject",
      .summary =
          "Link an account with a person of the OpenID Connect provider, or remove the link; this "
          "ends the account's sessions",
      .who = {Role::admin},
      .parameters = {path_text("id", "Id of the account")},
      .body = "OidcSubject",
      .body_limit_bytes = 4096,
      .answer = "",
      .schemas = {{"OidcSubject",
                   object({{"subject", text("Subject identifier (sub) of the person at the "
                                            "provider; an empty text removes the link")}})}},
      .handle = link};
  return {
      offer,
      open_route("/start", "oidcStart", "Redirect the browser to the provider to sign in", kBytes,
                 http::Lane::remote, begin),
      back,
      open_route("/end", "oidcEnd", "Redirect the browser to the provider to sign out there too",
                 kBytes, http::Lane::remote, leave),
      join};
}

}  // namespace api
}  // namespace tractus
