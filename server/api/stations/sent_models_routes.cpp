/// A version of a model on its way to stations: who is to have it, and what a station asks.
#include <set>

#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/stations/sent_models.hpp"
#include "server/api/backend.hpp"
#include "server/api/lab/lab_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxSentModel_bytes = 16384;
constexpr std::size_t kMaxStations = 200;

Result<store::ModelVersion> version_of(store::Reading& tx, const std::string& id) {
  auto model = TRY(store::model_of(tx, id));
  if (!model) return absent("model", id);
  return std::move(*model);
}

const char* state_of(const store::SentModel& one) {
  if (one.there_utc_us) return "there";
  return one.asked_utc_us ? "waiting" : "not_sent";
}

Json sent_json(const std::vector<store::SentModel>& sent) {
  Json list = Json::array();
  for (const auto& one : sent)
    list.push_back({{"id", one.station_id},
                    {"name", one.station_name},
                    {"state", state_of(one)},
                    {"asked_utc_us", core::or_null(one.asked_utc_us)},
                    {"asked_by", one.asked_by},
                    {"there_utc_us", core::or_null(one.there_utc_us)}});
  return {{"stations", list}};
}

Result<http::Response> where_sent(const Call& call) {
  auto sent =
      TRY(call.backend.store.read([&](store::Reading& tx) -> Result<std::vector<store::SentModel>> {
        auto model = TRY(version_of(tx, call.text("id")));
        return store::sent_to(tx, model.id);
      }));
  return json_response(sent_json(sent));
}

/// The stations that the body names; an empty result means all stations.
Result<std::optional<std::set<std::string>>> stations_asked(const Json& json) {
  core::Fields fields(json, "body");
  const Json* named = fields.member("stations", false);
  const Json* every = fields.member("all", false);
  const bool all = every && every->is_boolean() && every->get<bool>();
  const bool list = named && named->is_array() && !named->empty() &&
                    named->size() <= kMaxStations &&
                    std::ranges::all_of(*named, [](const Json& one) { return one.is_string(); });
  if (all == list)
    fields.wrong("stations", "either an array of station ids or \"all\": true is expected");
  TRY(fields.done());
  if (all) return std::optional<std::set<std::string>>();
  std::set<std::string> out;
  for (const Json& one : *named) out.insert(one.get<std::string>().substr(0, 64));
  return std::optional(std::move(out));
}

Result<std::set<std::string>> every_station(store::Reading& tx) {
  auto stations = TRY(store::all_stations(tx));
  std::set<std::string> out;
  for (const auto& one : stations)
    if (!one.revoked_utc_us) out.insert(one.station.id);
  return out;
}

Result<http::Response> send(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  auto asked = TRY(stations_asked(json));
  auto sent = TRY(
      call.backend.store.write([&](store::Writing& tx) -> Result<std::vector<store::SentModel>> {
        auto model = TRY(version_of(tx, call.text("id")));
        auto ids = TRY(asked ? Result<std::set<std::string>>(*asked) : every_station(tx));
        for (const std::string& id : ids)
          if (auto done =
                  store::send_model(tx, model.id, id, call.caller.name, call.backend.now_utc_us());
              !done)
            return done.error();
        return store::sent_to(tx, model.id);
      }));
  return json_response(sent_json(sent));
}

Result<http::Response> recall(const Call& call) {
  auto sent = TRY(
      call.backend.store.write([&](store::Writing& tx) -> Result<std::vector<store::SentModel>> {
        TRY(store::recall_model(tx, call.text("id"), call.text("station_id")));
        return store::sent_to(tx, call.text("id"));
      }));
  return json_response(sent_json(sent));
}

Result<http::Response> for_station(const Call& call) {
  auto models = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::models_for(tx, call.caller.id); }));
  Json list = Json::array();
  for (const auto& model : models)
    list.push_back(
        {{"id", model.id}, {"name", model.name}, {"rig", model.rig}, {"sha256", model.sha256}});
  return json_response({{"models", list}});
}

/// A model version that was sent to the caller. Errors: not_found, also for a version that was sent
/// only to other stations.
Result<store::ModelVersion> own_model(const Call& call) {
  return call.backend.store.read([&](store::Reading& tx) -> Result<store::ModelVersion> {
    auto models = TRY(store::models_for(tx, call.caller.id));
    for (auto& model : models)
      if (model.id == call.text("id")) return std::move(model);
    return absent("model", call.text("id"));
  });
}

Result<http::Response> file_for_station(const Call& call) {
  auto model = TRY(own_model(call));
  return http::file_response(TRY(call.backend.objects.file(model.sha256)), call.request,
                             "application/json");
}

Result<http::Response> is_there(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::note_model_there(tx, call.text("id"), call.caller.id, call.backend.now_utc_us());
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

RouteInfo sent_model_route(std::string method, std::string tail, std::string id,
                           std::string summary, std::string answer,
                           Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/station/models" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::station},
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters.push_back(path_text("id", "Id of the model version"));
  return out;
}

}  // namespace

std::vector<RouteInfo> sent_models_routes() {
  using namespace schema;
  RouteInfo where = lab_route("GET", "models/{id}/stations", "sentModel",
                              "List every station and whether the model version was sent to it",
                              "SentModel", where_sent);
  where.who.push_back(Role::technician);
  where.schemas = {
      {"SentModelStation",
       object(
           {{"id", text("Id of the station")},
            {"name", text("Name of the station")},
            {"state", one_of({"not_sent", "waiting", "there"},
                             "not_sent: the version was not sent; waiting: the station has not "
                             "fetched the version yet; there: the station has stored the version")},
            {"asked_utc_us", nullable(integer("us",
                                              "Time when the version was sent, in microseconds "
                                              "since 1970-01-01 UTC; null if it was not sent"))},
            {"asked_by",
             text("Name of the account that sent the version; empty if it was not sent")},
            {"there_utc_us",
             nullable(integer("us",
                              "Time when the station reported that it stored the version, in "
                              "microseconds since 1970-01-01 UTC; null until then"))}})},
      {"SentModel",
       object({{"stations", array(ref("SentModelStation"), "All stations, sorted by name")}})}};
  RouteInfo post = taking(
      lab_route(
          "POST", "models/{id}/send", "sendModel",
          "Send a model version to stations; each station fetches the version at its next request",
          "SentModel", send),
      "SendModel", kMaxSentModel_bytes,
      {{"SendModel",
        object(
            {{"stations",
              optional(array(text("Id of a station"),
                             "Stations to which the version is sent; give either this or all"))},
             {"all", optional(truth(
                         "True: the version is sent to every station that is not revoked"))}})}});
  post.who.push_back(Role::technician);
  post.ends = {{"id", Object::model, post.who}, {"/stations/*", Object::station, post.who}};
  RouteInfo back = lab_route(
      "DELETE", "models/{id}/stations/{station_id}", "recallModel",
      "Recall a model version from a station, which forgets the version at its next request",
      "SentModel", recall);
  back.who.push_back(Role::technician);
  back.parameters.push_back(path_text("station_id", "Id of the station"));
  back.ends = {{"id", Object::model, back.who}, {"station_id", Object::station, back.who}};
  RouteInfo list = sent_model_route("GET", "", "stationModels",
                                    "List the model versions that were sent to the calling station",
                                    "StationModels", for_station);
  list.schemas = {
      {"StationModel",
       object({{"id", text("Id of the model version, which never changes")},
               {"name", text("Name of the model")},
               {"rig", one_of({"probing", "palpation"}, "Rig for which the model was made")},
               {"sha256", text("SHA-256 of the model's file")}})},
      {"StationModels",
       object({{"models",
                array(ref("StationModel"),
                      "Model versions, sorted by the time when they were sent, oldest first")}})}};
  return {
      where,
      post,
      back,
      list,
      sent_model_route(
          "GET", "/{id}", "stationModelFile",
          "Read the file of a model version that was sent to the calling station, byte for byte",
          "ModelFile", file_for_station),
      sent_model_route("POST", "/{id}/there", "stationModelThere",
                       "Report that the calling station has stored the model version on its disk",
                       "", is_there)};
}

}  // namespace api
}  // namespace tractus
