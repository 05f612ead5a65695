/// The fleet: which stations there are and how they are, letting one in by a one-time code,
/// shutting one out, and what a station reports of itself.
#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/operations/notifications.hpp"
#include "db/store/stations/fleet.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/people/throttle.hpp"
#include "server/api/stations/station_state.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::NoteKind;

constexpr std::uint64_t kMaxStation_bytes = 4096;
constexpr std::int64_t kCodeLife_us = 3600ll * 1'000'000;

constexpr std::uint64_t kMaxReport_bytes = 64 * 1024;
constexpr std::int64_t kNotesShown = 20;

Result<http::Response> list_stations(const Call& call) {
  auto found =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_stations(tx); }));
  core::Json list = core::Json::array();
  for (const auto& entry : found) list.push_back(station_json(call.backend, entry, call.caller));
  return json_response({{"stations", list}});
}

/// The newest reports of a kind, as the station sent them.
Result<core::Json> notes(store::Reading& tx, const std::string& id, NoteKind kind) {
  auto found = TRY(store::station_notes(tx, id, kind, kNotesShown));
  core::Json out = core::Json::array();
  for (const store::StationNote& note : found) {
    auto json = TRY(core::parse_json(note.body, "station_reports"));
    out.push_back(std::move(json));
  }
  return out;
}

Result<http::Response> one_station(const Call& call) {
  const std::string& id = call.text("id");
  auto entry = TRY(station_entry(call.backend, id));
  core::Json out = station_json(call.backend, entry, call.caller);
  for (const auto& [field, kind] : {std::pair("self_tests", NoteKind::self_test),
                                    std::pair("calibrations", NoteKind::calibration)}) {
    auto list = TRY(call.backend.store.read(
        [&, kind = kind](store::Reading& tx) { return notes(tx, id, kind); }));
    out[field] = std::move(list);
  }
  return json_response(out);
}

/// The same report twice has no effect: a station that did not receive the answer sends it again.
Result<http::Response> report(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto said = TRY(wire::StationReport::from_json(json, "body"));
  const std::int64_t now = call.backend.now_utc_us();
  const std::string& id = call.caller.id;
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    if (said.self_test)
      TRY(store::add_station_note(
          tx,
          {id, NoteKind::self_test, said.self_test->at_utc_us, said.self_test->to_json().dump()},
          now));
    if (said.self_test && !said.self_test->passed)
      TRY(store::note_event(tx,
                            {.id = {},
                             .kind = store::NotificationKind::self_test_failed,
                             .key = fmt::format("self_test/{}/{}", id, said.self_test->at_utc_us),
                             .subject = id,
                             .at_utc_us = now}));
    if (!said.calibration) return {};
    return store::add_station_note(tx,
                                   {id, NoteKind::calibration, said.calibration->at_utc_us,
                                    said.calibration->to_json().dump()},
                                   now);
  }));
  if (call.backend.live) call.backend.live->reported({id, call.caller.name}, said);
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

Result<http::Response> make_code(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string name = fields.text("name", kMaxName);
  if (name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  TRY(fields.done());
  const std::string code = made_password();
  const std::int64_t now = call.backend.now_utc_us();
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::add_enrolment_code(tx, token_hash(code), name, now, now + kCodeLife_us);
  }));
  return json_response({{"name", name}, {"code", code}, {"expires_utc_us", now + kCodeLife_us}},
                       201);
}

/// The station has generated its token and sends only the SHA-256 of the token here. It first sends
/// the token itself with its next request.
Result<http::Response> enrol(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string code = fields.text("code", 64), key = fields.text("token_sha256", 64);
  if (!core::is_sha256(key)) fields.wrong("token_sha256", "64 hexadecimal characters are expected");
  TRY(fields.done());
  const store::Attempt attempt{store::Secret::enrolment_code, "", network_of(call.request.peer)};
  auto early = TRY(too_early(call.backend, attempt));
  if (early) return std::move(*early);
  const std::int64_t now = call.backend.now_utc_us();
  store::Station station{core::new_id(), ""};
  auto added = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto name = TRY(store::use_enrolment_code(tx, token_hash(code), now));
    station.name = name;
    store::AuditScope::is_by(name, core::name(Role::station));
    return store::add_station(tx, station, key, now);
  });
  if (!added && added.error().code == Errc::unauthorised) TRY(note_failure(call.backend, attempt));
  if (!added) return added.error();
  return json_response({{"id", station.id},
                        {"name", station.name},
                        {"case_signer", call.backend.secrets.case_key().public_hex}},
                       201);
}

Result<http::Response> revoke(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::revoke_station(tx, call.text("id"), call.backend.now_utc_us());
  }));
  if (call.backend.live) call.backend.live->dismiss(call.text("id"));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

/// The state of a station, with the times of its enrolment and revocation.
std::vector<schema::Field> entry_fields() {
  using namespace schema;
  std::vector<Field> out = station_state_fields();
  out.emplace_back("enrolled_utc_us",
                   integer("us", "Time of the enrolment, in microseconds since 1970-01-01 UTC"));
  out.emplace_back("revoked_utc_us",
                   nullable(integer("us",
                                    "Time when the station was revoked, in microseconds since "
                                    "1970-01-01 UTC; null if it is not revoked")));
  return out;
}

std::vector<NamedSchema> report_schemas() {
  using namespace schema;
  const core::Json check = object(
      {{"name", text("Name of the check")},
       {"passed", truth("True if the check passed")},
       {"value", nullable(number("as in unit", "Measured value; null if the check measures none"))},
       {"unit", text("Unit of value and limit; empty if they have no unit")},
       {"limit", nullable(number("as in unit", "Limit of the value; null if there is none"))},
       {"words", text("Result of the check in words")}});
  return {{"SelfTest",
           object({{"at_utc_us",
                    integer("us", "Time of the self-test, in microseconds since 1970-01-01 UTC")},
                   {"passed", truth("True if every check passed")},
                   {"checks", array(check, "Checks, in the order in which they ran")}})},
          {"Calibration",
           object({{"at_utc_us",
                    integer("us", "Time of the calibration, in microseconds since 1970-01-01 UTC")},
                   {"due_utc_us",
                    nullable(integer("us",
                                     "Time when the next calibration is due, in microseconds since "
                                     "1970-01-01 UTC; null if there is no due date"))},
                   {"kind", text("Kind of the calibration: what was calibrated")},
                   {"words", text("Result of the calibration in words")}})}};
}

RouteInfo station_route(std::string method, std::string tail, std::string id, std::string summary,
                        std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/stations" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::technician},
          .parameters = {},
          .body = "",
          .body_limit_bytes = kMaxStation_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> stations_routes() {
  using namespace schema;
  RouteInfo list = station_route("GET", "", "stations",
                                 "List the stations with their current state, sorted by name",
                                 "Stations", list_stations);
  list.who.push_back(Role::faculty);
  list.who.push_back(Role::director);
  list.schemas = {
      {"StationEntry", object(entry_fields())},
      {"Stations",
       object({{"stations", array(ref("StationEntry"), "All stations, sorted by name")}})}};
  RouteInfo one = station_route("GET", "/{id}", "station",
                                "Read one station with its newest self-tests and calibrations",
                                "Station", one_station);
  one.who = list.who;
  one.parameters = {path_text("id", "Id of the station")};
  one.schemas = report_schemas();
  std::vector<Field> whole = entry_fields();
  whole.emplace_back("self_tests", array(ref("SelfTest"), "Self-tests, newest first, at most 20"));
  whole.emplace_back("calibrations",
                     array(ref("Calibration"), "Calibrations, newest first, at most 20"));
  one.schemas.push_back({"Station", object(whole)});
  RouteInfo said{
      .method = "POST",
      .path = "/api/v1/station/report",
      .id = "reportStation",
      .summary =
          "Report a self-test or a calibration of the calling station; sending the same report "
          "again has no effect",
      .who = {Role::station},
      .parameters = {},
      .body = "StationReport",
      .body_limit_bytes = kMaxReport_bytes,
      .answer = "",
      .schemas = {{"StationReport",
                   object(
                       {{"self_test", optional(nullable(ref("SelfTest")))},
                        {"calibration", optional(nullable(ref("Calibration")))},
                        {"refused", optional(array(text("One refused case and the reason"),
                                                   "Cases that the station refused"))},
                        {"version", optional(nullable(text("Version of the station's program")))},
                        {"free_disk_bytes",
                         optional(nullable(
                             integer("B", "Free space on the station's disk, in bytes")))}})}},
      .handle = report};
  RouteInfo code =
      station_route("POST", "/codes", "makeEnrolmentCode",
                    "Create a code with which one station can enrol once within one hour",
                    "EnrolmentCode", make_code);
  code.body = "NewStation";
  code.schemas = {
      {"NewStation", object({{"name", text("Name of the new station")}})},
      {"EnrolmentCode",
       object(
           {{"name", text("Name of the new station")},
            {"code", text("Enrolment code, shown only in this answer")},
            {"expires_utc_us",
             integer("us", "Time when the code expires, in microseconds since 1970-01-01 UTC")}})}};
  RouteInfo in =
      station_route("POST", "/enrol", "enrolStation",
                    "Enrol a station with an enrolment code; the station sends the SHA-256 of "
                    "its token, and the token itself stays on the station",
                    "Enrolled", enrol);
  in.who = {};
  in.open = true;
  in.body = "Enrolment";
  in.schemas = {
      {"Enrolment", object({{"code", text("Enrolment code from makeEnrolmentCode")},
                            {"token_sha256",
                             text("SHA-256 of the station's token, 64 hexadecimal characters")}})},
      {"Enrolled",
       object(
           {{"id", text("Id of the station, which never changes")},
            {"name", text("Name of the station, as given for the enrolment code")},
            {"case_signer",
             text("Public key of the key with which this server signs cases, in hexadecimal")}})}};
  RouteInfo out = station_route(
      "POST", "/{id}/revoke", "revokeStation",
      "Revoke a station permanently; the server keeps the station's trials", "", revoke);
  out.parameters = {path_text("id", "Id of the station")};
  return {list, one, code, in, out, said};
}

}  // namespace api
}  // namespace tractus
