/// The model lab: versions of models, measurement sets as zips, diagnoses as jobs.
#include "db/store/lab.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "db/store/cases.hpp"
#include "db/store/jobs.hpp"
#include "models/probing_model.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxModel_bytes = 1 << 20, kMaxSet_bytes = 256 << 20, kMaxAsk_bytes = 4096;

Json or_null(const std::optional<std::string>& text) { return text ? Json(*text) : Json(); }

Error absent(const char* what, const std::string& id) {
  return {Errc::not_found, fmt::format("no {} {} here", what, id.substr(0, 64))};
}

Json model_json(const store::ModelVersion& m) {
  return {{"id", m.id},
          {"name", m.name},
          {"rig", m.rig},
          {"parent", or_null(m.parent)},
          {"diagnosis", or_null(m.diagnosis)},
          {"made_utc_us", m.made_utc_us},
          {"made_by", m.made_by}};
}

Result<http::Response> list_models(const Call& call) {
  const auto models =
      call.backend.store.read([](store::Reading& tx) { return store::all_models(tx); });
  if (!models) return models.error();
  Json list = Json::array();
  for (const auto& model : *models) list.push_back(model_json(model));
  return json_response({{"models", list}});
}

Result<http::Response> add_model(const Call& call) {
  const auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  const auto model = models::model_from_json(*json, "body: ");
  if (!model) return model.error();
  const auto sha256 = call.backend.objects.put(core::bytes_of(call.request.body));
  if (!sha256) return sha256.error();
  store::ModelVersion version;
  version.id = core::new_id();
  version.name = std::visit([](const auto& m) { return m.name; }, *model);
  version.rig = std::holds_alternative<models::ProbingModel>(*model) ? "probing" : "palpation";
  version.sha256 = *sha256;
  version.made_utc_us = call.backend.now_utc_us();
  version.made_by = call.caller.name;
  auto added = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    if (auto noted =
            store::add_object(tx, version.sha256, call.request.body.size(), version.made_utc_us);
        !noted)
      return noted;
    return store::add_model(tx, version);
  });
  if (!added) return added.error();
  return json_response(model_json(version), 201);
}

Result<http::Response> model_file(const Call& call) {
  const auto model = call.backend.store.read(
      [&](store::Reading& tx) { return store::model_of(tx, call.text("id")); });
  if (!model) return model.error();
  if (!*model) return absent("model", call.text("id"));
  return http::file_response(call.backend.objects.path_of((*model)->sha256), call.request,
                             "application/json");
}

Result<http::Response> add_set(const Call& call) {
  const std::string& body = call.request.body;
  if (!body.starts_with("PK"))
    return Error{Errc::bad_input,
                 "the body is not a zip; a zip of a folder with set.json is "
                 "expected"};
  const auto sha256 = call.backend.objects.put(core::bytes_of(body));
  if (!sha256) return sha256.error();
  const store::MeasurementSet set{*sha256, call.text("name").substr(0, 200),
                                  call.backend.now_utc_us(), call.caller.name};
  auto added = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    if (auto noted = store::add_object(tx, set.id, body.size(), set.made_utc_us); !noted)
      return noted;
    return store::add_measurement_set(tx, set);
  });
  if (!added) return added.error();
  return json_response({{"id", set.id}, {"size_bytes", body.size()}}, 201);
}

Result<Json> diagnosis_json(const Call& call, const store::DiagnosisRun& run) {
  const auto better =
      call.backend.store.read([&](store::Reading& tx) { return store::model_made_by(tx, run.id); });
  if (!better) return better.error();
  Json result;
  if (run.result) {
    auto read = core::read_json(call.backend.objects.path_of(*run.result));
    if (!read) return read.error();
    result = std::move(*read);
  }
  return Json{{"id", run.id},
              {"model", run.model_id},
              {"measurements", run.set_id},
              {"state", run.state},
              {"share", run.share},
              {"error", run.error},
              {"made_utc_us", run.made_utc_us},
              {"made_by", run.made_by},
              {"better_model", *better ? Json((*better)->id) : Json()},
              {"result", result}};
}

/// Reads {"model", "measurements"}.
Result<store::DiagnosisRun> wanted(const Call& call) {
  const auto json = core::parse_json(call.request.body, "body");
  if (!json) return json.error();
  core::Fields fields(*json, "");
  store::DiagnosisRun run;
  run.id = core::new_id();
  run.model_id = fields.text("model", 64);
  run.set_id = fields.text("measurements", 64);
  run.made_utc_us = call.backend.now_utc_us();
  run.made_by = call.caller.name;
  if (auto done = fields.done(); !done) return done.error();
  return run;
}

Result<http::Response> start_diagnosis(const Call& call) {
  const auto run = wanted(call);
  if (!run) return run.error();
  auto queued = call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    const auto model = store::model_of(tx, run->model_id);
    if (!model) return model.error();
    if (!*model) return absent("model", run->model_id);
    const auto set = store::measurement_set_of(tx, run->set_id);
    if (!set) return set.error();
    if (!*set) return absent("measurement set", run->set_id);
    if (auto added = store::add_diagnosis(tx, *run); !added) return added;
    return store::queue_job(tx, "diagnosis", run->id, run->made_utc_us);
  });
  if (!queued) return queued.error();
  call.backend.work_waits();
  const auto json = diagnosis_json(call, *run);
  if (!json) return json.error();
  return json_response(*json, 201);
}

Result<store::DiagnosisRun> run_of(const Call& call) {
  const auto run = call.backend.store.read(
      [&](store::Reading& tx) { return store::diagnosis_of(tx, call.text("id")); });
  if (!run) return run.error();
  if (!*run) return absent("diagnosis", call.text("id"));
  return **run;
}

Result<http::Response> diagnosis(const Call& call) {
  const auto run = run_of(call);
  if (!run) return run.error();
  const auto json = diagnosis_json(call, *run);
  if (!json) return json.error();
  return json_response(*json);
}

Result<http::Response> report_of(const Call& call) {
  const auto run = run_of(call);
  if (!run) return run.error();
  if (!run->report) return absent("report of the diagnosis", run->id);
  auto response = http::file_response(call.backend.objects.path_of(*run->report), call.request,
                                      "text/html; charset=utf-8");
  // A page of its own: it may show itself and do nothing else.
  if (response)
    response->with("Content-Security-Policy",
                   "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox");
  return response;
}

Result<http::Response> stop(const Call& call) {
  auto run = run_of(call);
  if (!run) return run.error();
  auto asked = call.backend.store.write([&](store::Writing& tx) {
    return store::ask_to_stop(tx, run->id, call.backend.now_utc_us());
  });
  if (!asked) return asked.error();
  return diagnosis(call);
}

RouteInfo route(std::string method, std::string tail, std::string id, std::string summary,
                std::string answer, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/lab/" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, Role::researcher},
                .parameters = {},
                .body = "",
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (out.path.find("{id}") != std::string::npos)
    out.parameters.push_back(path_text("id", "32 hexadecimal characters"));
  return out;
}

RouteInfo taking(RouteInfo out, std::string body, std::uint64_t limit_bytes,
                 std::vector<NamedSchema> schemas) {
  out.body = std::move(body);
  out.body_limit_bytes = limit_bytes;
  out.schemas = std::move(schemas);
  return out;
}

std::vector<NamedSchema> model_schemas() {
  using namespace schema;
  return {{"ModelFile", anything("tractus-model/1")},
          {"ModelVersion", object({{"id", text("of this version, which never changes")},
                                   {"name", text("for people")},
                                   {"rig", one_of({"probing", "palpation"}, "that it is of")},
                                   {"parent", nullable(text("the version it was made from"))},
                                   {"diagnosis", nullable(text("that made it"))},
                                   {"made_utc_us", integer("us", "since 1970, UTC")},
                                   {"made_by", text("who")}})}};
}

std::vector<NamedSchema> diagnosis_schemas() {
  using namespace schema;
  return {
      {"DiagnosisWanted",
       object({{"model", text("a version's id")}, {"measurements", text("a set's id")}})},
      {"Diagnosis", object({{"id", text("of this run")},
                            {"model", text("the version that is judged")},
                            {"measurements", text("the set that judges")},
                            {"state", one_of({"queued", "running", "done", "failed", "cancelled"},
                                             "how it stands")},
                            {"share", number("1", "of the work done")},
                            {"error", text("why it failed; else empty")},
                            {"made_utc_us", integer("us", "since 1970, UTC")},
                            {"made_by", text("who")},
                            {"better_model", nullable(text("the version it made"))},
                            {"result", nullable(anything("tractus-diagnosis/1"))}})}};
}

}  // namespace

std::vector<RouteInfo> lab_routes() {
  using namespace schema;
  RouteInfo list = route("GET", "models", "models", "Versions of models, newest first", "ModelList",
                         list_models);
  list.schemas = {{"ModelList", object({{"models", array(ref("ModelVersion"), "newest first")}})}};
  RouteInfo sets = taking(
      route("POST", "measurements", "addMeasurements",
            "Keep a measurement set: a zip of a folder with set.json; the same bytes are the same "
            "set",
            "MeasurementsKept", add_set),
      kBytes, kMaxSet_bytes,
      {{"MeasurementsKept",
        object({{"id", text("SHA-256 of the zip")}, {"size_bytes", integer("B", "of the zip")}})}});
  sets.parameters = {{.in = Parameter::In::query,
                      .name = "name",
                      .kind = Parameter::Kind::text,
                      .unit = "",
                      .meaning = "for people",
                      .required = true,
                      .fallback = std::nullopt}};
  return {list,
          taking(route("POST", "models", "addModel", "Keep a model as a new version",
                       "ModelVersion", add_model),
                 "ModelFile", kMaxModel_bytes, model_schemas()),
          route("GET", "models/{id}", "modelFile", "A version's file, byte for byte", "ModelFile",
                model_file),
          sets,
          taking(route("POST", "diagnoses", "startDiagnosis",
                       "Ask which effect a model lacks by a measurement set; done as a job",
                       "Diagnosis", start_diagnosis),
                 "DiagnosisWanted", kMaxAsk_bytes, diagnosis_schemas()),
          route("GET", "diagnoses/{id}", "diagnosis", "How far it is, and the result once done",
                "Diagnosis", diagnosis),
          route("GET", "diagnoses/{id}/report", "diagnosisReport", "The page of a finished one",
                kBytes, report_of),
          route("POST", "diagnoses/{id}/stop", "stopDiagnosis",
                "Stop it; one that ended stays as it is", "Diagnosis", stop)};
}

}  // namespace api
