/// Probing scenarios that people write here: checked as they type, kept as versions, offered for
/// assignments.
#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/cases/scenarios.hpp"
#include "scenarios/demand.hpp"
#include "server/api/cases/case_file_schemas.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/study_plan.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using scenarios::Scenario;

constexpr std::uint64_t kMaxScenario_bytes = 256u << 10;
constexpr std::array kSpeeds_m_s{0.002, 0.005, 0.010};

/// Reads a draft, which has no origin yet; the server writes the origin.
Result<Scenario> drafted(Json json, const scenarios::Origin& origin) {
  if (!json.is_object()) return Error{Errc::bad_input, ": an object is expected"};
  json["origin"] = {{"who", origin.who}, {"when", origin.when}, {"parent", origin.parent}};
  return scenario_from(json, "");
}

Json curve_json(const scenarios::Resistance& found) {
  Json at = Json::array(), layers = Json::array(), walls = Json::array();
  for (std::size_t k = 0; k < found.speeds_m_s.size(); ++k)
    at.push_back({{"speed_m_s", found.speeds_m_s[k]}, {"force_N", found.force_N[k]}});
  for (const auto& layer : found.parameters.layers)
    layers.push_back({{"from_m", layer.start_m}, {"to_m", layer.start_m + layer.thickness_m}});
  for (const auto& wall : found.parameters.walls)
    walls.push_back({{"from_m", wall.position_m - wall.resistance_interval_m},
                     {"at_m", wall.position_m},
                     {"to_m", wall.position_m + wall.breach_interval_m}});
  return {{"depth_m", found.depth_m}, {"at", at}, {"layers", layers}, {"walls", walls}};
}

/// Splits "/bone/stiffness_N_per_m: -1 is outside 0 … 200000" into the JSON pointer and the
/// sentence.
std::pair<std::string, std::string> field_and_words(std::string what) {
  while (what.starts_with(": ")) what.erase(0, 2);
  const auto colon = what.find(": ");
  if (!what.starts_with('/') || colon == std::string::npos) return {"", what};
  return {what.substr(0, colon), what.substr(colon + 2)};
}

Result<http::Response> check(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  const auto scenario = drafted(json, {call.caller.name, "now", ""});
  Json out{{"ok", bool(scenario)},
           {"field", ""},
           {"error", ""},
           {"curve", Json()},
           {"excessive", Json::array()}};
  if (!scenario) {
    std::tie(out["field"], out["error"]) = field_and_words(scenario.error().what);
    return json_response(out);
  }
  const auto found = TRY(scenarios::resistance(*scenario, kSpeeds_m_s));
  const auto demand = TRY(scenarios::demand(*scenario));
  out["curve"] = curve_json(found);
  out["excessive"] = demand.excessive;
  return json_response(out);
}

Json version_json(const store::ScenarioVersion& version) {
  return {{"id", version.id},
          {"name", version.name},
          {"kind", version.kind},
          {"parent", version.parent ? Json(*version.parent) : Json()},
          {"published", version.published},
          {"made_utc_us", version.made_utc_us},
          {"made_by", version.made_by}};
}

Result<http::Response> list(const Call& call) {
  const auto found = TRY(
      call.backend.store.read([](store::Reading& tx) { return store::all_scenario_versions(tx); }));
  Json versions = Json::array(), tuned = Json::array();
  for (const auto& version : found) versions.push_back(version_json(version));
  for (int kind = 0; kind < scenarios::kKinds; ++kind) {
    const auto one = TRY(scenarios::tuned(static_cast<scenarios::Kind>(kind)));
    tuned.push_back({{"kind", scenarios::name(one.kind)}, {"name", one.name}, {"id", one.id()}});
  }
  return json_response({{"scenarios", versions}, {"tuned", tuned}});
}

Error no_scenario(const std::string& id) {
  return {Errc::not_found, "no scenario " + id.substr(0, 64)};
}

/// The contents of a version; for the name of a kind, those of the tuned scenario of this kind.
Result<Scenario> contents(Backend& backend, const std::string& id) {
  if (const auto kind = core::from_name<scenarios::Kind>(id)) return scenarios::tuned(*kind);
  const auto version = TRY(
      backend.store.read([&](store::Reading& tx) { return store::scenario_version_of(tx, id); }));
  if (!version) return no_scenario(id);
  auto json = TRY(core::read_json(TRY(backend.objects.file(version->sha256))));
  return Scenario::from_json(json, "scenario " + id.substr(0, 12) + ": ");
}

Result<http::Response> one(const Call& call) {
  const auto scenario = TRY(contents(call.backend, call.text("id")));
  return json_response(scenario.to_json());
}

struct Draft {
  Scenario scenario;
  bool publish = false;
};

Result<Draft> draft_from(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* scenario = fields.member("scenario");
  const std::string parent = fields.text_or("parent", "", 64);
  const Json* publish = fields.member("publish", false);
  if (publish && !publish->is_boolean()) fields.wrong("publish", "true or false is expected");
  TRY(fields.done());
  scenarios::Origin origin{call.caller.name, core::utc_text(call.backend.now_utc_us()), ""};
  if (!parent.empty()) {
    const auto from = TRY(contents(call.backend, parent));
    origin.parent = from.id();
  }
  auto read = drafted(*scenario, origin);
  if (!read) return Error{read.error().code, "/scenario" + read.error().what};
  return Draft{std::move(*read), publish && publish->get<bool>()};
}

/// Publishes the version as a case that an assignment may name; the only part of the case is
/// secret.
Result<void> offer(store::Writing& tx, const store::ScenarioVersion& version,
                   const store::CasePart& part, std::int64_t now_utc_us) {
  const store::CaseSummary summary{version.id, version.name,       version.made_by, now_utc_us,
                                   0,          trial::Rig::probing};
  TRY(store::add_case(tx, summary, {part}, now_utc_us));
  return store::set_case_retired(tx, version.id, false, now_utc_us);
}

Result<http::Response> add(const Call& call) {
  const auto draft = TRY(draft_from(call));
  const Scenario& scenario = draft.scenario;
  const auto part = TRY(put_scenario(call.backend, scenario));
  const std::int64_t now = call.backend.now_utc_us();
  store::ScenarioVersion version{.id = scenario.id(),
                                 .sha256 = part.sha256,
                                 .name = scenario.name,
                                 .kind = std::string(scenarios::name(scenario.kind)),
                                 .parent = {},
                                 .published = draft.publish,
                                 .made_utc_us = now,
                                 .made_by = call.caller.name};
  if (!scenario.origin.parent.empty()) version.parent = scenario.origin.parent;
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::add_object(tx, part.sha256, part.size_bytes, now));
    TRY(store::add_scenario_version(tx, version));
    return version.published ? offer(tx, version, part, now) : Result<void>();
  }));
  return json_response(version_json(version), 201);
}

Result<http::Response> publish_scenario(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* published = fields.member("published");
  if (published && !published->is_boolean()) fields.wrong("published", "true or false is expected");
  TRY(fields.done());
  const std::string& id = call.text("id");
  const auto scenario = TRY(contents(call.backend, id));
  const auto part = TRY(put_scenario(call.backend, scenario));
  const std::int64_t now = call.backend.now_utc_us();
  auto version = TRY(call.backend.store.write(
      [&](store::Writing& tx) -> Result<std::optional<store::ScenarioVersion>> {
        const bool offered = published->get<bool>();
        TRY(store::set_scenario_published(tx, id, offered));
        auto now_is = store::scenario_version_of(tx, id);
        if (!now_is) return now_is;
        TRY(offered ? offer(tx, **now_is, part, now) : store::set_case_retired(tx, id, true, now));
        return now_is;
      }));
  return json_response(version_json(*version));
}

std::vector<NamedSchema> scenario_curve_schemas() {
  using namespace schema;
  const Json at =
      object({{"speed_m_s", number("m/s", "Constant speed of the tip into the bone, in m/s")},
              {"force_N", array(number("N", "Pushing force, in newtons"),
                                "Pushing force at each depth, in newtons")}});
  const Json layer = object({{"from_m", number("m", "Depth at which the layer begins, in metres")},
                             {"to_m", number("m", "Depth at which the layer ends, in metres")}});
  const Json wall = object(
      {{"from_m", number("m", "Depth at which the resistance begins to grow, in metres")},
       {"at_m", number("m", "Depth at which the wall breaks, in metres")},
       {"to_m", number("m", "Depth at which the soft tissue behind the wall ends, in metres")}});
  return {
      {"ScenarioCurve",
       object({{"depth_m", array(number("m", "Depth of the tip, in metres"),
                                 "Depths of the tip, measured from the entry, in metres")},
               {"at", array(at, "One curve for each speed, slowest first")},
               {"layers", array(layer, "Layers of bone, sorted by depth")},
               {"walls", array(wall, "Walls that can breach, sorted by depth")}})},
      {"ScenarioCheck",
       object(
           {{"ok", truth("True if the draft is valid, so that it can be stored and assigned")},
            {"field", text("JSON pointer to the invalid field; empty if the draft is valid or if "
                           "the error is not in a single field")},
            {"error", text("Description of the error; empty if the draft is valid")},
            {"curve", nullable(ref("ScenarioCurve"))},
            {"excessive", array(text("One demand, as a sentence"),
                                "Demands that exceed what a surgeon or the actuator can do")}})}};
}

std::vector<NamedSchema> version_schemas() {
  using namespace schema;
  const Json kind = one_of<scenarios::Kind>("Kind of the scenario");
  const Json tuned = object({{"kind", kind},
                             {"name", text("Name of the scenario")},
                             {"id", text("Id of the scenario's version")}});
  return {
      {"ScenarioVersion",
       object({{"id", text("Id of the version, a hash of its contents, 64 hexadecimal characters")},
               {"name", text("Name for faculty")},
               {"kind", kind},
               {"parent",
                nullable(text(
                    "Id of the version from which this version was made; null if there is none"))},
               {"published", truth("True if assignments can use the version")},
               {"made_utc_us",
                integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the account that created the version")}})},
      {"ScenarioVersions",
       object({{"scenarios",
                array(ref("ScenarioVersion"), "Versions written on this server, newest first")},
               {"tuned", array(tuned,
                               "Tuned scenarios that come with the program; routes take the kind "
                               "of such a scenario in place of an id")}})},
      {"NewScenario",
       object({{"scenario", ref("ScenarioDraft")},
               {"parent", optional(text("Id of the version from which the draft was made, or the "
                                        "kind of a tuned scenario"))},
               {"publish",
                optional(truth(
                    "True if assignments can use the version immediately; default false"))}})},
      {"Publication", object({{"published", truth("True if assignments can use the version")}})}};
}

RouteInfo scenario_route(std::string method, std::string tail, std::string id, std::string summary,
                         std::string body, std::string answer,
                         Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/scenarios" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, Role::faculty},
                .parameters = {},
                .body = std::move(body),
                .body_limit_bytes = kMaxScenario_bytes,
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (tail.starts_with("/{id}"))
    out.parameters = {path_text("id", "Id of a version, or the kind of a tuned scenario")};
  return out;
}

}  // namespace

std::vector<RouteInfo> scenarios_routes() {
  RouteInfo look = scenario_route(
      "POST", "/check", "checkScenario",
      "Check whether a draft is valid and compute the force that it needs at each depth",
      "ScenarioDraft", "ScenarioCheck", check);
  look.audited = false;  // it changes nothing
  look.schemas = scenario_curve_schemas();
  RouteInfo all =
      scenario_route("GET", "", "scenarios",
                     "List the versions of scenarios written on this server, newest first, and "
                     "the tuned scenarios that come with the program",
                     "", "ScenarioVersions", list);
  all.schemas = version_schemas();
  all.who.push_back(Role::director);  // a curriculum's steps are chosen from them
  RouteInfo file = scenario_route("GET", "/{id}", "scenario", "Read the file of a version", "",
                                  "ScenarioFile", one);
  file.schemas = scenario_file_schemas();
  return {look, all, file,
          scenario_route("POST", "", "addScenario", "Store a draft as a new version", "NewScenario",
                         "ScenarioVersion", add),
          scenario_route("POST", "/{id}/publish", "publishScenario",
                         "Publish a version, so that assignments can use it, or withdraw it",
                         "Publication", "ScenarioVersion", publish_scenario)};
}

}  // namespace api
}  // namespace tractus
