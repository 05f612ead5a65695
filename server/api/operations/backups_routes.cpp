/// Backups: made while the server serves, and tried by restoring them.
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/operations/backups.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

Json backup_json(const Backup& backup) {
  Json out{{"id", backup.id},
           {"state", backup.state},
           {"share", backup.share},
           {"error", backup.error},
           {"made_utc_us", backup.made_utc_us},
           {"made_by", backup.made_by},
           {"size_bytes", backup.size_bytes},
           {"trials", backup.trials},
           {"verified", nullptr}};
  if (backup.holds)
    out["verified"] = {{"holds", *backup.holds},
                       {"at_utc_us", backup.verified_utc_us},
                       {"findings", backup.findings}};
  return out;
}

Result<Backups*> of(const Call& call) {
  if (call.backend.backups) return call.backend.backups;
  return core::Error{core::Errc::unavailable, "this server makes no backups by itself"};
}

Result<http::Response> list_backups(const Call& call) {
  auto backups = TRY(of(call));
  auto found = TRY(backups->list());
  Json list = Json::array();
  for (const Backup& one : found) list.push_back(backup_json(one));
  return json_response({{"backups", list}});
}

Result<http::Response> make_backup(const Call& call) {
  auto backups = TRY(of(call));
  auto made = TRY(backups->make(call.caller.name));
  return json_response(backup_json(made), 201);
}

Result<http::Response> verify_backup(const Call& call) {
  auto backups = TRY(of(call));
  auto begun = TRY(backups->verify(call.text("id")));
  return json_response(backup_json(begun));
}

RouteInfo route(std::string method, std::string tail, std::string id, std::string summary,
                std::string answer, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/backups" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, Role::technician},
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "the backup's"));
  return out;
}

}  // namespace

std::vector<RouteInfo> backups_routes() {
  using namespace schema;
  RouteInfo list =
      route("GET", "", "backups", "Backups on this server, newest first", "Backups", list_backups);
  list.schemas = {
      {"BackupTrial", object({{"holds", truth("restored and looked over, nothing is wrong")},
                              {"at_utc_us", integer("us", "since 1970, UTC")},
                              {"findings", array(text("a line"), "what is wrong")}})},
      {"Backup",
       object({{"id", text("also its folder's name")},
               {"state", one_of({"making", "verifying", "done", "failed"}, "at the moment")},
               {"share", number("1", "of what is being done")},
               {"error", text("why it failed; else empty")},
               {"made_utc_us", integer("us", "since 1970, UTC")},
               {"made_by", text("who; empty: the command line")},
               {"size_bytes", integer("B", "on the disk")},
               {"trials", integer("1", "in it")},
               {"verified", nullable(ref("BackupTrial"))}})},
      {"Backups", object({{"backups", array(ref("Backup"), "newest first")}})}};
  return {
      list,
      route("POST", "", "makeBackup", "Make one, while everything goes on", "Backup", make_backup),
      route("POST", "/{id}/verify", "verifyBackup",
            "Restore one to a scratch folder and look it over", "Backup", verify_backup)};
}

}  // namespace api
}  // namespace tractus
