/// Signing in and out.
#include "core/require.hpp"
#include "server/api/authentication.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace api {
namespace {

struct Credentials {
  std::string name, password;
};

core::Result<Credentials> credentials(const http::Request& request) {
  auto json = core::parse_json(request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "body");
  Credentials out{fields.text("name", kMaxName), fields.text("password", kMaxPassword)};
  if (auto fine = fields.done(); !fine) return fine.error();
  return out;
}

std::string cookie(const std::string& token, std::int64_t seconds) {
  return std::string(kSessionCookie) + "=" + token +
         "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" + std::to_string(seconds);
}

core::Result<http::Response> sign_in_route(const Call& call) {
  auto given = credentials(call.request);
  if (!given) return given.error();
  auto in = sign_in(call.backend, given->name, given->password, call.request.peer);
  if (!in && is_throttled(in.error())) {
    auto refusal = http::error_response(429, "too_many", in.error().what);
    return refusal.with("Retry-After", std::to_string(kThrottleWindow_us / 1'000'000)), refusal;
  }
  if (!in) return in.error();
  auto response = json_response({{"name", in->account.name}, {"role", in->account.role}});
  response.with("Set-Cookie", cookie(in->token, kSessionAge_us / 1'000'000));
  return response;
}

core::Result<http::Response> who_am_i(const Call& call) {
  return json_response({{"name", call.caller.name}, {"role", name(call.caller.role)}});
}

core::Result<http::Response> sign_out_route(const Call& call) {
  auto done = call.backend.store.write(
      [&](store::Writing& tx) { return store::remove_session(tx, call.caller.session_hash); });
  if (!done) return done.error();
  http::Response response{.status = 204, .headers = {}, .body = std::string()};
  return response.with("Set-Cookie", cookie("", 0)), response;
}

}  // namespace

std::vector<RouteInfo> session_routes() {
  const std::string path = "/api/v1/session";
  const core::Json identity =
      schema::object({{"name", schema::text("of the account or the station")},
                      {"role", schema::one_of({"admin", "station"}, "what it may do")}});
  const core::Json sent = schema::object(
      {{"name", schema::text("of the account")}, {"password", schema::text("at most 1024 bytes")}});
  return {{.method = "POST",
           .path = path,
           .id = "signIn",
           .summary = "Sign in; the answer sets the session's cookie",
           .who = {},
           .open = true,
           .parameters = {},
           .body = "Credentials",
           .body_limit_bytes = 8192,
           .answer = "Identity",
           .schemas = {{"Credentials", sent}, {"Identity", identity}},
           .handle = sign_in_route},
          {.method = "GET",
           .path = path,
           .id = "whoAmI",
           .summary = "Whose credentials these are",
           .who = {Role::admin, Role::station},
           .parameters = {},
           .body = "",
           .answer = "Identity",
           .schemas = {},
           .handle = who_am_i},
          {.method = "DELETE",
           .path = path,
           .id = "signOut",
           .summary = "Sign out; the session is over everywhere",
           .who = {Role::admin},
           .parameters = {},
           .body = "",
           .answer = "",
           .schemas = {},
           .handle = sign_out_route}};
}

}  // namespace api
