/// The learning record store to which statements of trials are sent, for administrators.
#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/learning/record_stores.hpp"
#include "server/api/backend.hpp"
#include "server/api/learning/tool.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

constexpr std::uint64_t kMaxRecordStore_bytes = 8192;

Result<http::Response> show_record_store(const Call& call) {
  const auto found =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::record_store(tx); }));
  if (!found) return json_response({{"store", Json()}});
  return json_response({{"store",
                         {{"endpoint", found->endpoint},
                          {"key", found->key},
                          {"made_utc_us", found->made_utc_us},
                          {"made_by", found->made_by}}}});
}

Result<http::Response> set_record_store_route(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::RecordStore wanted{.id = core::new_id(),
                            .endpoint = fields.text("endpoint", 2000),
                            .key = fields.text("key", 255),
                            .secret = fields.text("secret", 1024),
                            .made_utc_us = call.backend.now_utc_us(),
                            .made_by = call.caller.name};
  while (wanted.endpoint.ends_with('/')) wanted.endpoint.pop_back();
  if (!is_callable(wanted.endpoint, outside_networks(call.backend)))
    fields.wrong("endpoint", "an https address is expected");
  if (wanted.key.empty() || wanted.key.find(':') != std::string::npos)  // RFC 7617 section 2
    fields.wrong("key", "a text without ':' is expected");
  if (wanted.secret.empty()) fields.wrong("secret", "a text is expected");
  TRY(fields.done());
  if (!call.backend.pseudonym_key)
    return core::Error{core::Errc::conflict,
                       "this server has no key of pseudonyms (--pseudonym-key), by which "
                       "statements name people"};
  wanted.secret = call.backend.secrets.sealed(wanted.secret);
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::set_record_store(tx, wanted); }));
  return show_record_store(call);
}

Result<http::Response> remove_record_store_route(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_record_store(tx, call.backend.now_utc_us());
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

RouteInfo record_store_route(std::string method, std::string id, std::string summary,
                             Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/record-store",
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin},
          .parameters = {},
          .body = "",
          .answer = "RecordStore",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> record_store_routes() {
  using namespace schema;
  RouteInfo show = record_store_route("GET", "recordStore",
                                      "Show the learning record store (xAPI) to which statements "
                                      "of trials are sent",
                                      show_record_store);
  show.schemas = {
      {"RecordStore",
       object({{"store",
                nullable(object(
                    {{"endpoint", text("Address of the store, to which /statements is added")},
                     {"key", text("Name with which the server signs in there")},
                     {"made_utc_us", integer("us",
                                             "Time of the setting, in microseconds since "
                                             "1970-01-01 UTC; trials received earlier are not "
                                             "stated")},
                     {"made_by", text("Name of the account that set it")}}))}})}};
  RouteInfo set = record_store_route("POST", "setRecordStore",
                                     "Set the learning record store: statements of released trials "
                                     "of people who consented to the tier metrics are sent there, "
                                     "by pseudonym, from now on",
                                     set_record_store_route);
  set.body = "NewRecordStore";
  set.body_limit_bytes = kMaxRecordStore_bytes;
  set.schemas = {
      {"NewRecordStore",
       object({{"endpoint", text("Address of the store, https")},
               {"key", text("Name with which the server signs in there")},
               {"secret", text("Secret that belongs to the key; it is kept encrypted")}})}};
  RouteInfo remove = record_store_route("DELETE", "removeRecordStore",
                                        "Remove the learning record store; statements that wait "
                                        "are withdrawn",
                                        remove_record_store_route);
  remove.answer = "";
  return {show, set, remove};
}

}  // namespace api
}  // namespace tractus
