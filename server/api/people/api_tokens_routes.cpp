/// Personal API tokens: made by their owner with the password, revoked by the owner or an
/// administrator. No token may call these routes.
#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/owner_proof.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/people/token_scopes.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxApiToken_bytes = 8192;
constexpr std::size_t kMaxTokenName_bytes = 64;
constexpr std::int64_t kDay_us = 24ll * 3600 * 1'000'000;
constexpr std::int64_t kTokenLife_us = 366 * kDay_us;

Json token_json(const store::ApiToken& token) {
  Json scopes = Json::array();
  for (const TokenScope scope : token.scopes) scopes.push_back(name(scope));
  return {{"id", token.id},
          {"name", token.name},
          {"owner", token.owner},
          {"scopes", scopes},
          {"made_utc_us", token.made_utc_us},
          {"expires_utc_us", token.expires_utc_us},
          {"used_utc_us", core::or_null(token.used_utc_us)},
          {"revoked_utc_us", core::or_null(token.revoked_utc_us)},
          {"revoked_by", core::or_null(token.revoked_by)}};
}

Json scopes_json(Role role) {
  Json out = Json::array();
  for (const TokenScope scope : scopes_for(role))
    out.push_back({{"scope", name(scope)}, {"meaning", meaning(scope)}});
  return out;
}

Result<http::Response> tokens_response(const Call& call) {
  const auto tokens = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::api_tokens_of(tx, call.caller.id); }));
  Json list = Json::array();
  for (const auto& token : tokens) list.push_back(token_json(token));
  return json_response({{"tokens", list}, {"scopes", scopes_json(call.caller.role)}});
}

Result<http::Response> all_tokens_response(const Call& call) {
  const auto tokens = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::valid_api_tokens(tx, call.backend.now_utc_us()); }));
  Json list = Json::array();
  for (const auto& token : tokens) list.push_back(token_json(token));
  return json_response({{"tokens", list}, {"scopes", scopes_json(call.caller.role)}});
}

/// Known scopes, of which the role may use each, once each.
std::vector<TokenScope> scopes_field(core::Fields& fields, Role role) {
  const Json* given = fields.member("scopes");
  std::vector<TokenScope> out;
  if (!given) return out;
  if (!given->is_array() || given->empty() || given->size() > core::names<TokenScope>().size()) {
    fields.wrong("scopes", "an array of at least one scope is expected");
    return out;
  }
  const auto allowed = scopes_for(role);
  for (const Json& one : *given) {
    const auto scope =
        one.is_string() ? core::from_name<TokenScope>(one.get<std::string>()) : std::nullopt;
    if (!scope || std::ranges::count(out, *scope) > 0)
      fields.wrong("scopes",
                   "each of these at most once is expected: " + core::names_listed<TokenScope>());
    else if (std::ranges::count(allowed, *scope) == 0)
      fields.wrong("scopes", fmt::format("the role {} may call no route of the scope {}",
                                         name(role), name(*scope)));
    else
      out.push_back(*scope);
  }
  return out;
}

struct WantedToken {
  store::ApiToken token;
  OwnerProof proof;
};

Result<WantedToken> wanted_token(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::int64_t now = call.backend.now_utc_us();
  WantedToken out{
      .token = {.id = core::new_id(),
                .account_id = call.caller.id,
                .name = fields.text("name", kMaxTokenName_bytes),
                .scopes = scopes_field(fields, call.caller.role),
                .made_utc_us = now,
                .expires_utc_us = fields.integer("expires_utc_us", now + 1, now + kTokenLife_us),
                .owner = call.caller.name},
      .proof = {"password", fields.text("password", kMaxPassword), fields.text_or("code", "", 16)}};
  const std::string& name = out.token.name;
  if (name.find_first_not_of(" \t") == std::string::npos || core::one_line(name) != name)
    fields.wrong("name", "a name on one line is expected");
  TRY(fields.done());
  return out;
}

Result<http::Response> make_api_token(const Call& call) {
  const auto wanted = TRY(wanted_token(call));
  auto refusal = TRY(refusal_of(call, wanted.proof));
  if (refusal) return std::move(*refusal);
  const std::string token = kApiTokenPrefix + new_token();
  bool wrong = false;
  const auto made = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto account = TRY(account_of_session(tx, call));
    if (account.totp_confirmed) {
      TRY(take_code(call, account, wanted.proof.code, wrong));
      TRY(store::use_totp_step(tx, account.id, account.totp_step));
    }
    TRY(store::clear_failures(tx, own_attempt_of(call)));
    return store::add_api_token(tx, wanted.token, token_hash(token));
  });
  if (wrong) TRY(note_failure(call.backend, own_attempt_of(call)));
  if (!made) return made.error();
  return json_response({{"token", token}, {"entry", token_json(wanted.token)}}, 201);
}

Result<http::Response> revoke_token(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::revoke_api_token(tx, call.text("id"), token_end_of(call));
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

std::vector<NamedSchema> token_schemas() {
  using namespace schema;
  const char* utc = "Time, in microseconds since 1970-01-01 UTC";
  return {{"ApiToken",
           object({{"id", text("Id of the token's entry, 32 hexadecimal characters")},
                   {"name", text("Name that the owner gave the token")},
                   {"owner", text("Name of the account that the token acts for")},
                   {"scopes", array(one_of<TokenScope>("Scope"), "What the token may do")},
                   {"made_utc_us", integer("us", utc)},
                   {"expires_utc_us", integer("us",
                                              "Time from which the token is invalid, in "
                                              "microseconds since 1970-01-01 UTC")},
                   {"used_utc_us",
                    nullable(integer("us",
                                     "Time of the last use, to the minute, in microseconds "
                                     "since 1970-01-01 UTC; null if it was never used"))},
                   {"revoked_utc_us", nullable(integer("us",
                                                       "Time at which the token was revoked, in "
                                                       "microseconds since 1970-01-01 UTC"))},
                   {"revoked_by", nullable(text("Name of the account that revoked the token"))}})},
          {"ScopeOffered", object({{"scope", one_of<TokenScope>("Scope")},
                                   {"meaning", text("What a token with this scope may do")}})},
          {"ApiTokens",
           object({{"tokens", array(ref("ApiToken"), "Tokens")},
                   {"scopes", array(ref("ScopeOffered"),
                                    "Scopes that the caller's role allows for a new token")}})}};
}

RouteInfo token_route(std::string method, std::string id, std::string summary,
                      Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/tokens",
          .id = std::move(id),
          .summary = std::move(summary),
          .who = people(),
          .parameters = {},
          .body = "",
          .answer = "ApiTokens",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> api_tokens_routes() {
  using namespace schema;
  RouteInfo list = token_route("GET", "apiTokens",
                               "List the caller's API tokens, newest first, without the tokens "
                               "themselves",
                               tokens_response);
  list.schemas = token_schemas();
  RouteInfo all = token_route("GET", "allApiTokens",
                              "List the valid API tokens of all accounts, sorted by owner",
                              all_tokens_response);
  all.path = "/api/v1/accounts/tokens";
  all.who = {Role::admin};
  RouteInfo make = token_route("POST", "makeApiToken",
                               "Make an API token of the caller, which is shown only in this "
                               "answer; programs send it as Authorization: Bearer TOKEN",
                               make_api_token);
  make.lane = http::Lane::hashing;
  make.body = "NewApiToken";
  make.body_limit_bytes = kMaxApiToken_bytes;
  make.answer = "ApiTokenMade";
  make.schemas = {
      {"NewApiToken",
       object({{"name", text("Name of the token, at most 64 bytes")},
               {"scopes", array(one_of<TokenScope>("Scope"), "What the token may do")},
               {"expires_utc_us",
                integer("us",
                        "Time from which the token is invalid, in microseconds since "
                        "1970-01-01 UTC; at most 366 days from now")},
               {"password", text("Current password of the caller")},
               {"code", optional(text("One-time code of six digits; required if the account uses "
                                      "one-time codes"))}})},
      {"ApiTokenMade", object({{"token", text("The token, shown only in this answer")},
                               {"entry", ref("ApiToken")}})}};
  RouteInfo revoke = token_route("DELETE", "revokeApiToken",
                                 "Revoke an API token: it is invalid from then on", revoke_token);
  revoke.path += "/{id}";
  revoke.answer = "";
  revoke.parameters = {path_text("id", "Id of the token's entry")};
  revoke.object = Object::api_token;
  for (Grant& grant : revoke.who)
    if (grant.role != Role::admin) grant.of = Scope::own;
  return {list, all, make, revoke};
}

}  // namespace api
}  // namespace tractus
