/// The audit trail, for administrators.
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/backend.hpp"
#include "server/api/finding/list_request.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

core::Json row_json(const store::AuditRow& row) {
  return {{"number", row.number},     {"at_utc_us", row.act.at_utc_us},
          {"who", row.act.who},       {"role", row.act.role},
          {"peer", row.act.peer},     {"what", row.act.what},
          {"object", row.act.object}, {"detail", core::stored_json(row.act.detail)},
          {"hash", row.hash}};
}

core::Result<http::Response> list_audit(const Call& call) {
  const auto request = TRY(list_request(call, store::audit_list()));
  auto found = TRY(
      call.backend.store.read([&](store::Reading& tx) { return store::find_audit(tx, request); }));
  core::Json list = core::Json::array();
  for (const auto& row : found.rows) list.push_back(row_json(row));
  return json_response(with_page({{"rows", list}}, found.page));
}

/// Recomputes the whole hash chain.
core::Result<http::Response> check_audit(const Call& call) {
  auto end = call.backend.store.read(
      [&](store::Reading& tx) { return store::verify_chain(tx, call.backend.store.audit_key()); });
  if (!end && end.error().code != core::Errc::corrupt) return end.error();
  return json_response({{"holds", bool(end)},
                        {"rows", end ? core::Json(end->number) : core::Json()},
                        {"hash", end ? core::Json(end->hash) : core::Json()},
                        {"failure", end ? core::Json() : core::Json(end.error().what)}});
}

}  // namespace

std::vector<RouteInfo> audit_routes() {
  using namespace schema;
  RouteInfo list{.method = "GET",
                 .path = "/api/v1/audit",
                 .id = "audit",
                 .summary = "List rows of the audit trail: who changed what and when",
                 .who = {Role::admin},
                 .parameters = list_parameters(store::audit_list(),
                                               "account, action, object, details or address"),
                 .body = "",
                 .answer = "AuditRows",
                 .schemas = {},
                 .handle = list_audit};
  std::vector<Field> rows = page_fields();
  rows.emplace_back("rows",
                    array(ref("AuditRow"), "Rows of the audit trail, in the order asked for"));
  list.schemas = {
      {"AuditRow",
       object({{"number", integer("1", "Number of the audit row, counted from 1 without gaps")},
               {"at_utc_us",
                integer("us", "Time of the action, in microseconds since 1970-01-01 UTC")},
               {"who", text("Name of the account or station that acted; \"command line: USER\" for "
                            "a command of tractus-server")},
               {"role", text("Role of the account or station at the time of the action")},
               {"peer", text("Network address from which the request came; empty for a command")},
               {"what",
                text("Action: an operationId of this description, or a command of tractus-server")},
               {"object", text("Arguments in the path of the request, for example id=…")},
               {"detail", anything("Fields of the request's body, without secrets")},
               {"hash", text("Hash of this row and of all rows before it")}})},
      {"AuditRows", object(rows)}};
  RouteInfo check{.method = "GET",
                  .path = "/api/v1/audit/check",
                  .id = "checkAudit",
                  .summary =
                      "Recompute the hash chain of the audit trail to find rows that were altered, "
                      "removed or reordered",
                  .who = {Role::admin},
                  .parameters = {},
                  .body = "",
                  .answer = "AuditCheck",
                  .schemas = {},
                  .handle = check_audit};
  check.schemas = {
      {"AuditCheck",
       object({{"holds", truth("True if every row of the chain is intact")},
               {"rows", nullable(integer("1", "Number of checked rows; null if the check failed"))},
               {"hash", nullable(text("Hash of the newest row; null if the check failed"))},
               {"failure", nullable(text("Description of the first row that fails the check; null "
                                         "if the chain is intact"))}})}};
  return {list, check};
}

}  // namespace api
}  // namespace tractus
