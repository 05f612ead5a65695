/// Learning platforms that may launch this server's pages, for administrators.
#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/people/subjects.hpp"
#include "server/api/backend.hpp"
#include "server/api/learning/tool.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/oidc.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxPlatform_bytes = 16 * 1024;
constexpr std::size_t kMaxDeployments = 50, kMaxIdentifier = 255;

Json platform_json(const store::Platform& one) {
  return {{"id", one.id},
          {"issuer", one.issuer},
          {"client_id", one.client_id},
          {"deployments", one.deployments},
          {"authorization_url", one.authorization_url},
          {"token_url", one.token_url},
          {"keys_url", one.keys_url},
          {"match_email", one.match_email},
          {"made_utc_us", one.made_utc_us},
          {"made_by", one.made_by}};
}

Result<http::Response> list_platforms(const Call& call) {
  const auto all =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_platforms(tx); }));
  Json list = Json::array();
  for (const store::Platform& one : all) list.push_back(platform_json(one));
  const ToolAddresses tool = tool_addresses(call.backend);
  return json_response({{"platforms", list},
                        {"login_url", tool.login},
                        {"launch_url", tool.launch},
                        {"keys_url", tool.keys}});
}

std::vector<std::string> deployments_field(core::Fields& fields) {
  std::vector<std::string> out;
  const Json* given = fields.member("deployments");
  const bool fits = given && given->is_array() && !given->empty() &&
                    given->size() <= kMaxDeployments &&
                    std::ranges::all_of(*given, [](const Json& one) {
                      return one.is_string() && !one.get<std::string>().empty() &&
                             one.get<std::string>().size() <= kMaxIdentifier;
                    });
  if (given && !fits) fields.wrong("deployments", "an array of 1 to 50 ids is expected");
  if (fits)
    for (const Json& one : *given) out.push_back(one.get<std::string>());
  return out;
}

std::string address_field(core::Fields& fields, const char* key, const http::Networks& networks) {
  const std::string out = fields.text(key);
  if (!is_callable(out, networks)) fields.wrong(key, "an https address is expected");
  return out;
}

Result<http::Response> add_platform_route(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto networks = outside_networks(call.backend);
  store::Platform platform{
      .id = core::new_id(),
      .issuer = fields.text("issuer", kMaxIdentifier),
      .client_id = fields.text("client_id", kMaxIdentifier),
      .deployments = deployments_field(fields),
      .authorization_url = address_field(fields, "authorization_url", networks),
      .token_url = address_field(fields, "token_url", networks),
      .keys_url = address_field(fields, "keys_url", networks),
      .made_utc_us = call.backend.now_utc_us(),
      .made_by = call.caller.name};
  if (const Json* match = fields.member("match_email", false)) {
    if (!match->is_boolean()) fields.wrong("match_email", "true or false is expected");
    platform.match_email = *match == Json(true);
  }
  for (const auto& [key, value] :
       {std::pair("issuer", platform.issuer), std::pair("client_id", platform.client_id)})
    if (value.empty()) fields.wrong(key, "a text is expected");
  TRY(fields.done());
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::add_platform(tx, platform); }));
  return json_response(platform_json(platform), 201);
}

http::Response no_content() { return {.status = 204, .headers = {}, .body = std::string()}; }

Result<http::Response> remove_platform_route(const Call& call) {
  const std::string kept = call.backend.oidc ? call.backend.oidc->settings().issuer : "";
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_platform(tx, call.text("id"), kept, call.backend.now_utc_us());
  }));
  return no_content();
}

Result<http::Response> link_person(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string account_name = fields.text("account", kMaxName);
  const std::string subject = fields.text_or("subject", "", kMaxIdentifier);
  TRY(fields.done());
  std::string account_id;
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    const auto platform = TRY(store::platform_of(tx, call.text("id")));
    if (!platform) return absent("platform", call.text("id"));
    const auto account = TRY(store::account_named(tx, account_name));
    if (!account)
      return Error{Errc::not_found, "body: /account: there is no account with this name"};
    account_id = account->id;
    TRY(store::link_subject(
        tx, {platform->issuer, subject, account->id, call.backend.now_utc_us(), call.caller.name}));
    return store::remove_sessions_of(tx, account->id, "");
  }));
  close_conversations(call.backend, account_id);
  return no_content();
}

RouteInfo platform_route(std::string method, std::string tail, std::string id, std::string summary,
                         Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/lti/platforms" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin},
                .parameters = {},
                .body = "",
                .answer = "",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters = {path_text("id", "Id of the platform")};
  return out;
}

std::vector<schema::Field> registration_fields() {
  using namespace schema;
  return {{"issuer", text("Issuer identifier of the platform (iss)")},
          {"client_id", text("Client id of this server at the platform")},
          {"deployments", array(text("Deployment id"), "The only deployments that may launch")},
          {"authorization_url",
           text("Address to which browsers are sent for a launch (OIDC authentication), https")},
          {"token_url", text("Address of access tokens, https")},
          {"keys_url", text("Address of the platform's public keys (JWKS), https")}};
}

std::vector<NamedSchema> platform_schemas() {
  using namespace schema;
  std::vector<Field> kept = registration_fields();
  kept.insert(kept.begin(), {"id", text("Id of the platform, 32 hexadecimal characters")});
  kept.emplace_back("match_email",
                    truth("True if an e-mail address that the platform verified links a trainee"));
  kept.emplace_back("made_utc_us",
                    integer("us", "Time of registration, in microseconds since 1970-01-01 UTC"));
  kept.emplace_back("made_by", text("Name of the account that registered the platform"));
  return {
      {"LtiPlatform", object(kept)},
      {"LtiPlatforms",
       object({{"platforms", array(ref("LtiPlatform"), "Platforms, by issuer and client id")},
               {"login_url", text("To enter at the platform: address that begins a launch")},
               {"launch_url", text("To enter at the platform: address of launches (redirect)")},
               {"keys_url", text("To enter at the platform: address of this server's keys")}})}};
}

RouteInfo adding_platform() {
  using namespace schema;
  RouteInfo out = platform_route("POST", "", "addLtiPlatform",
                                 "Register a learning platform, which may then launch pages by "
                                 "LTI 1.3",
                                 add_platform_route);
  std::vector<Field> wished = registration_fields();
  wished.emplace_back("match_email",
                      optional(truth("True: an e-mail address that the platform says it verified "
                                     "links the only trainee with this address; default false")));
  out.body = "NewLtiPlatform";
  out.body_limit_bytes = kMaxPlatform_bytes;
  out.answer = "LtiPlatform";
  out.schemas = {{"NewLtiPlatform", object(wished)}};
  return out;
}

RouteInfo linking_person() {
  using namespace schema;
  RouteInfo out = platform_route("POST", "/{id}/people", "linkLtiPerson",
                                 "Link an account with a person of a learning platform, or remove "
                                 "the link; this ends the account's sessions",
                                 link_person);
  out.ends = {{"/account", Object::account, {Role::admin}, End::By::account_name}};
  out.body = "LtiPerson";
  out.body_limit_bytes = 4096;
  out.schemas = {
      {"LtiPerson",
       object({{"account", text("Name of the account")},
               {"subject", optional(text("Identifier of the person at the platform (sub), which a "
                                         "refused launch left in the audit trail; if it is "
                                         "missing, the link is removed"))}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> lti_platforms_routes() {
  RouteInfo list = platform_route("GET", "", "ltiPlatforms",
                                  "List the learning platforms, and the addresses of this server "
                                  "that a platform needs",
                                  list_platforms);
  list.answer = "LtiPlatforms";
  list.schemas = platform_schemas();
  return {list, adding_platform(),
          platform_route("DELETE", "/{id}", "removeLtiPlatform",
                         "Remove a learning platform with the links of its people; scores that "
                         "wait for it are withdrawn",
                         remove_platform_route),
          linking_person()};
}

}  // namespace api
}  // namespace tractus
