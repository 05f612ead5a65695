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
           {"state", name(backup.state)},
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
  return core::Error{core::Errc::unavailable, "this server cannot make backups on request"};
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

RouteInfo backup_route(std::string method, std::string tail, std::string id, std::string summary,
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
  if (!tail.empty()) out.parameters.push_back(path_text("id", "Id of the backup"));
  return out;
}

}  // namespace

std::vector<RouteInfo> backups_routes() {
  using namespace schema;
  RouteInfo list =
      backup_route("GET", "", "backups", "List the backups on this server, newest first", "Backups",
                   list_backups);
  list.schemas = {
      {"BackupTrial",
       object(
           {{"holds",
             truth("True if the backup was restored and the check of the copy found no error")},
            {"at_utc_us", integer("us", "Time of the check, in microseconds since 1970-01-01 UTC")},
            {"findings",
             array(text("One error"), "Errors that the check found; empty if there are none")}})},
      {"Backup",
       object({{"id", text("Id of the backup, which is also the name of its folder")},
               {"state", one_of<BackupState>("State of the backup")},
               {"share", number("1", "Completed share of the backup or of its check, 0 to 1")},
               {"error", text("Reason for the failure; empty if the backup did not fail")},
               {"made_utc_us",
                integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
               {"made_by",
                text("Name of the account that made the backup; empty if a command made it")},
               {"size_bytes", integer("B", "Size of the backup on the disk, in bytes")},
               {"trials", integer("1", "Number of trials in the backup")},
               {"verified", nullable(ref("BackupTrial"))}})},
      {"Backups", object({{"backups", array(ref("Backup"), "All backups, newest first")}})}};
  return {
      list,
      backup_route("POST", "", "makeBackup",
                   "Make a backup; the server continues to work meanwhile", "Backup", make_backup),
      backup_route("POST", "/{id}/verify", "verifyBackup",
                   "Check a backup: restore it to a temporary folder and check the copy", "Backup",
                   verify_backup)};
}

}  // namespace api
}  // namespace tractus
