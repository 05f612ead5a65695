/// Stations at work: the wall of those who look on, the line of each station, and what may be asked
/// of one from afar: to stop, to give less force. Never more.
#include "core/try.hpp"
#include "server/api/stations/station_state.hpp"

namespace tractus {
namespace api {
namespace {

using core::Result;

constexpr std::uint64_t kMaxLive_bytes = 4096;
constexpr std::size_t kMaxStopReason = 300;

using Conversing = Result<std::shared_ptr<http::WebSocketHandler>>;

Conversing look_on(const Call& call, std::function<bool()> may_stay) {
  auto hub = TRY(hub_of(call.backend));
  return hub->viewer_talk(viewer_of(call.caller), std::move(may_stay));
}

Conversing station_line(const Call& call, std::function<bool()> may_stay) {
  auto hub = TRY(hub_of(call.backend));
  return hub->station_talk({call.caller.id, call.caller.name}, std::move(may_stay));
}

Result<http::Response> time_now(const Call& call) {
  return json_response({{"server_utc_us", call.backend.now_utc_us()}});
}

/// Writes the command into the audit trail, then sends it to the station.
Result<http::Response> commanded(const Call& call, const wire::StationCommand& command) {
  auto hub = TRY(hub_of(call.backend));
  const std::string& id = call.text("id");
  TRY(station_entry(call.backend, id));
  TRY(call.backend.store.write([](store::Writing&) { return Result<void>(); }));
  TRY(hub->command(id, command));
  return json_response({{"sent", true}}, 202);
}

Result<http::Response> stop_trial(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  wire::StationCommand command;
  command.reason = fields.text("reason", kMaxStopReason);
  if (command.reason.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("reason", "a reason is expected; the person at the station reads it");
  TRY(fields.done());
  return commanded(call, command);
}

Result<http::Response> limit(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  wire::StationCommand command{.kind = wire::StationCommand::Kind::limits, .reason = {}};
  command.force_N = fields.number("force_N", 0.0, 1000.0);
  TRY(fields.done());
  return commanded(call, command);
}

RouteInfo line(std::string tail, std::string id, std::string summary, std::vector<Grant> who,
               std::string frames,
               Conversing (*converse)(const Call&, std::function<bool()> may_stay)) {
  return {.method = "GET",
          .path = "/api/v1/live" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = std::move(who),
          .parameters = {},
          .body = "",
          .answer = std::move(frames),
          .schemas = {},
          .handle = wants_websocket,
          .converse = converse};
}

RouteInfo command(std::string tail, std::string id, std::string summary, std::vector<Grant> who,
                  std::string body, Result<http::Response> (*handle)(const Call&)) {
  return {.method = "POST",
          .path = "/api/v1/stations/{id}/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = std::move(who),
          .parameters = {path_text("id", "Id of the station")},
          .body = std::move(body),
          .body_limit_bytes = kMaxLive_bytes,
          .answer = "CommandSent",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> live_routes() {
  using namespace schema;
  RouteInfo wall =
      line("", "live",
           "WebSocket for watching stations: sends the state of all stations once, then each "
           "station that changes, at most 20 times a second",
           {Role::admin, Role::director, Role::faculty, Role::technician}, "LiveFrame", look_on);
  wall.schemas = {
      {"StationState", object(station_state_fields())},
      {"LiveFrame",
       object({{"kind", one_of({"stations", "station"},
                               "stations: the message has the field stations; station: it has the "
                               "field station")},
               {"stations", optional(array(ref("StationState"), "All stations, sorted by name"))},
               {"station", optional(ref("StationState"))}})}};
  RouteInfo own = line("/station", "liveStation",
                       "WebSocket for a station: the station sends its state and receives commands",
                       {Role::station}, "StationCommand", station_line);
  own.schemas = {
      {"StationCommand",
       object(
           {{"kind",
             one_of({"stop", "limits"},
                    "Command: stop = end the running trial, limits = lower the force limit")},
            {"reason", optional(text("Reason for the stop, shown to the person at the station"))},
            {"force_N",
             optional(number("N", "New limit of the force on the hand, in newtons"))}})}};
  const std::vector<Grant> watching{Role::admin, Role::director, Role::faculty, Role::technician};
  RouteInfo halt = command(
      "stop", "stopStation",
      "Stop the running trial and set the force to zero; a person at the station must resume",
      watching, "StopStation", stop_trial);
  halt.schemas = {
      {"StopStation",
       object({{"reason",
                text("Reason for the stop, shown at the station, at most 300 characters")}})},
      {"CommandSent",
       object(
           {{"sent", truth("True: the server sent the command over the station's connection")}})}};
  RouteInfo less = command("limits", "limitStation",
                           "Lower the force limit of a station; this route cannot raise the limit",
                           {Role::admin, Role::technician}, "LimitStation", limit);
  less.schemas = {
      {"LimitStation",
       object({{"force_N",
                number("N", "New limit of the force on the hand, in newtons, 0 to 1000")}})}};
  RouteInfo time{
      .method = "GET",
      .path = "/api/v1/time",
      .id = "time",
      .summary = "Read the server's clock, with which a station compares its own clock",
      .who = {Role::station},
      .parameters = {},
      .body = "",
      .answer = "ServerTime",
      .schemas =
          {{"ServerTime",
            object(
                {{"server_utc_us",
                  integer("us",
                          "Time of the server's clock, in microseconds since 1970-01-01 UTC")}})}},
      .handle = time_now};
  return {wall, own, halt, less, time};
}

}  // namespace api
}  // namespace tractus
