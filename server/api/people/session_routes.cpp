/// Signing in and out.
#include "core/require.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

core::Result<Credentials> credentials(const http::Request& request) {
  auto json = TRY(core::parse_json(request.body, "body"));
  core::Fields fields(json, "body");
  Credentials out{fields.text("name", kMaxName), fields.text("password", kMaxPassword),
                  fields.text_or("code", "", 16)};
  TRY(fields.done());
  return out;
}

core::Json identity_json(const Caller& caller) {
  return {{"name", caller.name},
          {"role", name(caller.role)},
          {"id", caller.id},
          {"must_change", caller.must_change},
          {"language", core::or_null(caller.language)}};
}

core::Result<http::Response> sign_in_route(const Call& call) {
  auto given = TRY(credentials(call.request));
  const store::Attempt attempt{store::Secret::account_password, given.name,
                               network_of(call.request.peer)};
  auto early = TRY(too_early(call.backend, attempt));
  if (early) return std::move(*early);
  auto in = sign_in(call.backend, given, attempt);
  if (!in && needs_code(in.error()))
    return http::error_response(401, "code_needed", in.error().what);
  if (!in) return in.error();
  const store::Account& account = in->account;
  auto response = json_response(identity_json({.role = account.role,
                                               .id = account.id,
                                               .name = account.name,
                                               .session_hash = {},
                                               .must_change = account.must_change,
                                               .language = account.language}));
  response.with("Set-Cookie", session_cookie(call.backend, in->token));
  return response;
}

core::Result<http::Response> who_am_i(const Call& call) {
  return json_response(identity_json(call.caller));
}

core::Result<http::Response> sign_out_route(const Call& call) {
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::remove_session(tx, call.caller.session_hash); }));
  http::Response response{.status = 204, .headers = {}, .body = std::string()};
  return response.with("Set-Cookie", session_cookie(call.backend, "")), response;
}

}  // namespace

std::vector<RouteInfo> session_routes() {
  const std::string path = "/api/v1/session";
  const core::Json identity = schema::object(
      {{"name", schema::text("Name of the account or the station")},
       {"role", schema::one_of<Role>("Role, which decides what the caller may do")},
       {"id", schema::text("Id of the account or the station")},
       {"must_change",
        schema::truth("True if the person must choose a new password before any other request")},
       {"language", schema::nullable(schema::text("Language that the person chose, for example "
                                                  "de; null if none was chosen"))}});
  const core::Json sent = schema::object(
      {{"name", schema::text("Name of the account")},
       {"password", schema::text("Password, at most 1024 bytes")},
       {"code", schema::optional(schema::text("One-time code of six digits; required if the error "
                                              "code of the previous answer was code_needed"))}});
  return {{.method = "POST",
           .path = path,
           .id = "signIn",
           .summary = "Sign in with name and password; the answer sets the session cookie",
           .who = {},
           .open = true,
           .lane = http::Lane::hashing,
           .parameters = {},
           .body = "Credentials",
           .body_limit_bytes = 8192,
           .answer = "Identity",
           .schemas = {{"Credentials", sent}, {"Identity", identity}},
           .handle = sign_in_route},
          {.method = "GET",
           .path = path,
           .id = "whoAmI",
           .summary = "Show which account or station the caller's credentials belong to",
           .who = {kRoles.begin(), kRoles.end()},
           .before_password_change = true,
           .parameters = {},
           .body = "",
           .answer = "Identity",
           .schemas = {},
           .handle = who_am_i},
          {.method = "DELETE",
           .path = path,
           .id = "signOut",
           .summary = "Sign out and end the session",
           .who = people(),
           .before_password_change = true,
           .parameters = {},
           .body = "",
           .answer = "",
           .schemas = {},
           .handle = sign_out_route}};
}

}  // namespace api
}  // namespace tractus
