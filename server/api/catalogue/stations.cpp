/// The fleet: which stations there are, letting one in by a one-time code, shutting one out.
#include <fmt/format.h>

#include "core/bytes.hpp"
#include "db/store/audit.hpp"
#include "server/api/authentication.hpp"
#include "server/api/backend.hpp"
#include "server/api/people_json.hpp"
#include "server/api/schema.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMaxBody_bytes = 4096;
constexpr std::int64_t kCodeLife_us = 3600ll * 1'000'000;
constexpr const char* kEnrolling = "station enrolment";  ///< the throttle's name for codes

core::Json time_or_null(const std::optional<std::int64_t>& time) {
  return time ? core::Json(*time) : core::Json();
}

core::Json station_json(const store::StationEntry& entry) {
  return {{"id", entry.station.id},
          {"name", entry.station.name},
          {"enrolled_utc_us", entry.enrolled_utc_us},
          {"revoked_utc_us", time_or_null(entry.revoked_utc_us)}};
}

Result<http::Response> list_stations(const Call& call) {
  auto found = call.backend.store.read([](store::Reading& tx) { return store::all_stations(tx); });
  if (!found) return found.error();
  core::Json list = core::Json::array();
  for (const auto& entry : *found) list.push_back(station_json(entry));
  return json_response({{"stations", list}});
}

Result<http::Response> make_code(const Call& call) {
  auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "body");
  const std::string name = fields.text("name", kMaxName);
  if (name.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("name", "a name is expected");
  if (auto done = fields.done(); !done) return done.error();
  const std::string code = made_password();
  const std::int64_t now = call.backend.now_utc_us();
  auto added = call.backend.store.write([&](store::Writing& tx) {
    return store::add_enrolment_code(tx, token_hash(code), name, now, now + kCodeLife_us);
  });
  if (!added) return added.error();
  return json_response({{"name", name}, {"code", code}, {"expires_utc_us", now + kCodeLife_us}},
                       201);
}

/// The station has made a key of its own; its SHA-256 comes here, the key itself is first sent with
/// the station's next request, to a server that knows it.
Result<http::Response> enrol(const Call& call) {
  auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "body");
  const std::string code = fields.text("code", 64), key = fields.text("token_sha256", 64);
  if (!core::is_sha256(key)) fields.wrong("token_sha256", "64 hexadecimal characters are expected");
  if (auto done = fields.done(); !done) return done.error();
  const std::string& peer = call.request.peer;
  if (auto open = check_throttle(call.backend, kEnrolling, peer); !open) return open.error();
  const std::int64_t now = call.backend.now_utc_us();
  store::Station station{core::new_id(), ""};
  auto added = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto name = store::use_enrolment_code(tx, token_hash(code), now);
    if (!name) return name.error();
    station.name = *name;
    store::Acting::is_by(*name, std::string(api::name(Role::station)));
    return store::add_station(tx, station, key, now);
  });
  if (!added && added.error().code == Errc::unauthorised)
    if (auto noted = note_failure(call.backend, kEnrolling, peer); !noted) return noted.error();
  if (!added) return added.error();
  return json_response({{"id", station.id},
                        {"name", station.name},
                        {"case_signer", call.backend.secrets.case_key().public_hex}},
                       201);
}

Result<http::Response> revoke(const Call& call) {
  auto done = call.backend.store.write([&](store::Writing& tx) {
    return store::revoke_station(tx, call.text("id"), call.backend.now_utc_us());
  });
  if (!done) return done.error();
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

RouteInfo route(std::string method, std::string tail, std::string id, std::string summary,
                std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/stations" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::technician},
          .parameters = {},
          .body = "",
          .body_limit_bytes = kMaxBody_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> stations_routes() {
  using namespace schema;
  RouteInfo list = route("GET", "", "stations", "Stations by name", "Stations", list_stations);
  list.who.push_back(Role::faculty);
  list.schemas = {
      {"StationEntry",
       object({{"id", text("never changes")},
               {"name", text("for people")},
               {"enrolled_utc_us", integer("us", "since 1970, UTC")},
               {"revoked_utc_us", nullable(integer("us", "shut out since; null: it is not"))}})},
      {"Stations", object({{"stations", array(ref("StationEntry"), "by name")}})}};
  RouteInfo code =
      route("POST", "/codes", "makeEnrolmentCode",
            "A code that lets one station in, once, within an hour", "EnrolmentCode", make_code);
  code.body = "NewStation";
  code.schemas = {
      {"NewStation", object({{"name", text("of the station to come")}})},
      {"EnrolmentCode", object({{"name", text("of the station")},
                                {"code", text("shown only now")},
                                {"expires_utc_us", integer("us", "since 1970, UTC")}})}};
  RouteInfo in = route("POST", "/enrol", "enrolStation",
                       "A station with a code says what its key hashes to; the key stays there",
                       "Enrolled", enrol);
  in.who = {};
  in.open = true;
  in.body = "Enrolment";
  in.schemas = {
      {"Enrolment", object({{"code", text("from makeEnrolmentCode")},
                            {"token_sha256", text("of the station's own key, 64 hexadecimal")}})},
      {"Enrolled",
       object({{"id", text("never changes")},
               {"name", text("as in the code")},
               {"case_signer", text("public key that this server signs cases with")}})}};
  RouteInfo out = route("POST", "/{id}/revoke", "revokeStation",
                        "Shut a station out for good; its trials stay", "", revoke);
  out.parameters = {path_text("id", "the station's")};
  return {list, code, in, out};
}

}  // namespace api
