/// The audit trail, for administrators.
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

constexpr double kEnd = 9e15;  // exact in a double

core::Json row_json(const store::AuditRow& row) {
  return {{"number", row.number},     {"at_utc_us", row.act.at_utc_us},
          {"who", row.act.who},       {"role", row.act.role},
          {"peer", row.act.peer},     {"what", row.act.what},
          {"object", row.act.object}, {"detail", core::stored_json(row.act.detail)},
          {"hash", row.hash}};
}

core::Result<http::Response> list_audit(const Call& call) {
  auto found = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::audit_before(tx, call.integer("before"), call.integer("limit"));
  }));
  core::Json list = core::Json::array();
  for (const auto& row : found) list.push_back(row_json(row));
  return json_response({{"rows", list}});
}

/// The whole chain, recomputed.
core::Result<http::Response> check_audit(const Call& call) {
  auto end = call.backend.store.read(
      [&](store::Reading& tx) { return store::verify_chain(tx, call.backend.store.audit_key()); });
  if (!end && end.error().code != core::Errc::corrupt) return end.error();
  return json_response({{"holds", bool(end)},
                        {"rows", end ? core::Json(end->number) : core::Json()},
                        {"hash", end ? core::Json(end->hash) : core::Json()},
                        {"failure", end ? core::Json() : core::Json(end.error().what)}});
}

Parameter whole(std::string name, std::string meaning, double high, std::string fallback) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::integer,
          .unit = "1",
          .meaning = std::move(meaning),
          .low = 1,
          .high = high,
          .fallback = std::move(fallback)};
}

}  // namespace

std::vector<RouteInfo> audit_routes() {
  using namespace schema;
  RouteInfo list{
      .method = "GET",
      .path = "/api/v1/audit",
      .id = "audit",
      .summary = "Every change, newest first: who, what, when, with which words",
      .who = {Role::admin},
      .parameters = {whole("limit", "at most so many", 500, "100"),
                     whole("before", "rows before this number", kEnd, "9000000000000000")},
      .body = "",
      .answer = "AuditRows",
      .schemas = {},
      .handle = list_audit};
  list.schemas = {{"AuditRow", object({{"number", integer("1", "from 1, without gaps")},
                                       {"at_utc_us", integer("us", "since 1970, UTC")},
                                       {"who", text("account, station, or command line: USER")},
                                       {"role", text("of it then")},
                                       {"peer", text("address it came from")},
                                       {"what", text("an operationId of this description, or a "
                                                     "command of tractus-server")},
                                       {"object", text("the path's arguments")},
                                       {"detail", anything("the body, without secrets")},
                                       {"hash", text("of this row and all before it")}})},
                  {"AuditRows", object({{"rows", array(ref("AuditRow"), "newest first")}})}};
  RouteInfo check{.method = "GET",
                  .path = "/api/v1/audit/check",
                  .id = "checkAudit",
                  .summary = "Recompute the chain: was anything altered, taken out or reordered?",
                  .who = {Role::admin},
                  .parameters = {},
                  .body = "",
                  .answer = "AuditCheck",
                  .schemas = {},
                  .handle = check_audit};
  check.schemas = {
      {"AuditCheck", object({{"holds", truth("nothing was tampered with")},
                             {"rows", nullable(integer("1", "checked"))},
                             {"hash", nullable(text("of the newest row"))},
                             {"failure", nullable(text("the first row that fails"))}})}};
  return {list, check};
}

}  // namespace api
}  // namespace tractus
