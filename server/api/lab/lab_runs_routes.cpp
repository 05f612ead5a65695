/// What is asked of the model lab: diagnoses, comparisons and fits as jobs, and what came of them.
#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/lab/lab.hpp"
#include "db/store/operations/jobs.hpp"
#include "lab/io/kept_samples.hpp"
#include "lab/io/own_effect.hpp"
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
using store::LabRunKind;

constexpr std::uint64_t kMaxLabRunsAsk_bytes = 256 << 10;
constexpr std::size_t kMostOwn = 8, kMostAdded = 16;
constexpr double kLongest_s = 1e6;

/// Reads the user effects and the effects that the user adds, if the kind of run allows them.
Result<void> read_wish(core::Fields& fields, store::LabRun& run) {
  Json wish{{"add", Json::array()}, {"own", Json::array()}};
  if (run.kind == LabRunKind::fit && fields.has("add")) wish["add"] = *fields.member("add");
  if (run.kind != LabRunKind::comparison && fields.has("own")) wish["own"] = *fields.member("own");
  const auto texts = [](const Json& all) {
    return all.is_array() && all.size() <= kMostAdded &&
           std::ranges::all_of(all, [](const Json& one) { return one.is_string(); });
  };
  if (!texts(wish["add"]))
    return Error{Errc::bad_input, fmt::format("add: at most {} ids are expected", kMostAdded)};
  if (!wish["own"].is_array() || wish["own"].size() > kMostOwn)
    return Error{Errc::bad_input, fmt::format("own: at most {} effects are expected", kMostOwn)};
  run.wish = wish.dump();
  return {};
}

Result<store::LabRun> wanted(const Call& call, LabRunKind kind) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "");
  store::LabRun run;
  run.id = core::new_id();
  run.kind = kind;
  run.model_id = fields.text("model", 64);
  run.set_id = fields.text("measurements", 64);
  run.made_utc_us = call.backend.now_utc_us();
  run.made_by = call.caller.name;
  if (run.kind == LabRunKind::comparison && fields.has("against")) {
    if (json["against"].is_null())
      fields.skip("against");
    else
      run.against_id = fields.text("against", 64);
  }
  TRY(read_wish(fields, run));
  TRY(fields.done());
  return run;
}

/// Checks that the models and the set exist and belong to one rig, and that the user effects are
/// valid.
Result<void> check(store::Reading& tx, const store::LabRun& run) {
  const auto set = TRY(store::measurement_set_of(tx, run.set_id));
  if (!set) return absent("measurement set", run.set_id);
  std::string rig;
  for (const std::string& id : {run.model_id, run.against_id.value_or("")}) {
    if (id.empty()) continue;
    const auto model = TRY(store::model_of(tx, id));
    if (!model) return absent("model", id);
    rig = model->rig;
    if (set->rig && *set->rig != rig)
      return Error{
          Errc::bad_input,
          fmt::format("a model of the {} rig, but measurements of the {} rig", rig, *set->rig)};
  }
  std::vector<lab_io::OwnEffect> own;
  for (const Json& one : own_effects(run))
    own.push_back({one, fmt::format("own[{}]: ", own.size())});
  TRY(lab_io::ids_of(own, rig));
  return {};
}

Result<http::Response> start(const Call& call, LabRunKind kind) {
  const auto run = TRY(wanted(call, kind));
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check(tx, run));
    TRY(store::add_lab_run(tx, run));
    return store::queue_job(tx, store::JobKind::lab, run.id, run.made_utc_us);
  }));
  call.backend.work_waits();
  return json_response(run_json(run, std::nullopt), 201);
}

Result<http::Response> start_diagnosis(const Call& call) {
  return start(call, LabRunKind::diagnosis);
}
Result<http::Response> start_comparison(const Call& call) {
  return start(call, LabRunKind::comparison);
}
Result<http::Response> start_fit(const Call& call) { return start(call, LabRunKind::fit); }

Result<http::Response> list_runs(const Call& call) {
  using Runs = std::vector<std::pair<store::LabRun, std::optional<store::ModelVersion>>>;
  const auto kind = core::from_name<LabRunKind>(call.text("kind"));
  if (!kind && !call.text("kind").empty())
    return Error{Errc::bad_input,
                 "kind: one of " + core::names_listed<LabRunKind>() + " is expected"};
  const auto runs = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Runs> {
    const auto found = TRY(store::lab_runs(tx, {.kind = kind,
                                                .model_id = call.text("model"),
                                                .set_id = call.text("measurements"),
                                                .limit = call.integer("limit")}));
    Runs out;
    for (const auto& run : found) {
      auto published = TRY(store::model_made_by(tx, run.id));
      out.emplace_back(run, std::move(published));
    }
    return out;
  }));
  Json list = Json::array();
  for (const auto& [run, published] : runs) list.push_back(run_json(run, published));
  return json_response({{"runs", list}});
}

Result<store::LabRun> run_of(const Call& call) {
  const auto run = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::lab_run_of(tx, call.text("id")); }));
  if (!run) return absent("run of the lab", call.text("id"));
  return *run;
}

Result<http::Response> one_run(const Call& call) {
  const auto run = TRY(run_of(call));
  const auto json = TRY(whole_run_json(call, run));
  return json_response(json);
}

Result<http::Response> report_of(const Call& call) {
  const auto run = TRY(run_of(call));
  if (!run.report) return absent("report of the run", run.id);
  auto response = TRY(http::file_response(TRY(call.backend.objects.file(*run.report)), call.request,
                                          "text/html; charset=utf-8"));
  return as_report(std::move(response));
}

Result<http::Response> better_model(const Call& call) {
  const auto run = TRY(run_of(call));
  if (!run.model) return absent("model of the run", run.id);
  return http::file_response(TRY(call.backend.objects.file(*run.model)), call.request,
                             "application/json");
}

Result<http::Response> stop_run(const Call& call) {
  const auto run = TRY(run_of(call));
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::ask_to_stop(tx, run.id, call.backend.now_utc_us());
  }));
  return one_run(call);
}

Json envelope(const lab_io::Envelope& e) { return {{"min", e.least}, {"max", e.most}}; }

Result<http::Response> signals(const Call& call) {
  const auto run = TRY(run_of(call));
  if (!run.samples) return absent("samples of the run", run.id);
  const std::string& side = call.text("side");
  if (side != "before" && side != "after")
    return Error{Errc::bad_input, "side: before or after is expected"};
  const auto view = TRY(lab_io::view_samples(TRY(call.backend.objects.file(*run.samples)),
                                             {.trial = call.text("trial"),
                                              .channel = call.text("channel"),
                                              .after = side == "after",
                                              .from_s = call.number("from_s"),
                                              .to_s = call.number("to_s"),
                                              .points = std::size_t(call.integer("points"))}));
  Json regions = Json::array();
  for (const auto& spans : view.regions) {
    regions.push_back(Json::array());
    for (const auto& [from, to] : spans) regions.back().push_back({from, to});
  }
  return json_response({{"trial", call.text("trial")},
                        {"channel", call.text("channel")},
                        {"side", side},
                        {"duration_s", view.duration_s},
                        {"t_s", view.t_s},
                        {"measured", envelope(view.measured)},
                        {"simulated", envelope(view.simulated)},
                        {"residual", envelope(view.residual)},
                        {"noise_floor", view.noise_floor},
                        {"samples_per_point", view.samples_per_point},
                        {"regions", regions}});
}

struct Words {
  std::string name, note;
};

Result<Words> version_words(const Call& call) {
  if (call.request.body.empty()) return Words{};
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "");
  Words out;
  if (fields.has("name")) out.name = fields.text("name", 200);
  if (fields.has("note")) out.note = fields.text("note", 2000);
  TRY(fields.done());
  return out;
}

/// Stores the improved model under the wanted name; with an unchanged name its bytes stay the same.
Result<std::pair<std::string, std::uint64_t>> named_model(const Call& call,
                                                          const store::LabRun& run,
                                                          std::string& name) {
  auto json = TRY(core::read_json(TRY(call.backend.objects.file(*run.model))));
  if (name.empty()) name = json.value("name", "");
  json["name"] = name;
  const std::string text = json.dump(2) + "\n";
  auto sha256 = TRY(call.backend.objects.put(core::bytes_of(text)));
  return std::pair(sha256, std::uint64_t(text.size()));
}

Result<http::Response> publish_run(const Call& call) {
  const auto run = TRY(run_of(call));
  auto words = TRY(version_words(call));
  if (!run.model)
    return Error{Errc::conflict, fmt::format("this {} has no model to publish: it is {}",
                                             name(run.kind), name(run.state))};
  const auto file = TRY(named_model(call, run, words.name));
  bool made = false;
  auto version =
      TRY(call.backend.store.write([&](store::Writing& tx) -> Result<store::ModelVersion> {
        auto already = TRY(store::model_made_by(tx, run.id));
        if (already) return *already;
        const auto parent = TRY(store::model_of(tx, run.model_id));
        if (!parent) return absent("model", run.model_id);
        const std::int64_t now = call.backend.now_utc_us();
        TRY(store::add_object(tx, file.first, file.second, now));
        store::ModelVersion out{core::new_id(), words.name, parent->rig, file.first,
                                parent->id,     run.id,     now,         call.caller.name,
                                words.note};
        TRY(store::add_model(tx, out));
        made = true;
        return out;
      }));
  return json_response(model_json(version), made ? 201 : 200);
}

Parameter numeric(std::string name, Parameter::Kind kind, std::string unit, std::string meaning,
                  double low, double high, std::string fallback) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = kind,
          .unit = std::move(unit),
          .meaning = std::move(meaning),
          .required = false,
          .low = low,
          .high = high,
          .fallback = std::move(fallback)};
}

Parameter required_text(std::string name, std::string meaning) {
  Parameter out = optional_text(std::move(name), std::move(meaning));
  out.required = true;
  out.fallback = std::nullopt;
  return out;
}

RouteInfo asking(const char* tail, const char* id, const char* summary, const char* body,
                 core::Json schema, Result<http::Response> (*handle)(const Call&)) {
  return taking(lab_route("POST", tail, id, summary, "LabRun", handle), body, kMaxLabRunsAsk_bytes,
                {{body, std::move(schema)}});
}

std::vector<RouteInfo> asking_routes() {
  using namespace schema;
  const Json model = text("Id of the model version"), set = text("Id of the measurement set");
  const Json own = schema::optional(array(ref("EffectFile"), "User effects, at most 8"));
  return {
      asking(
          "diagnoses", "startDiagnosis",
          "Queue a diagnosis: which physical effect does a model lack, judged by a measurement set",
          "DiagnosisWanted", object({{"model", model}, {"measurements", set}, {"own", own}}),
          start_diagnosis),
      asking("comparisons", "startComparison",
             "Queue a comparison of one or two model versions with a measurement set",
             "ComparisonWanted",
             object({{"model", model},
                     {"measurements", set},
                     {"against",
                      schema::optional(nullable(text("Id of the second model version; null or "
                                                     "missing: only one model is compared")))}}),
             start_comparison),
      asking("fits", "startFit",
             "Queue a fit of a model, with the effects that the user adds, to a measurement set",
             "FitWanted",
             object({{"model", model},
                     {"measurements", set},
                     {"add", schema::optional(
                                 array(text("Id of an effect"),
                                       "Effects that the fit adds to the model, at most 16"))},
                     {"own", own}}),
             start_fit)};
}

RouteInfo signals_route() {
  using namespace schema;
  using Kind = Parameter::Kind;
  RouteInfo out = lab_route(
      "GET", "runs/{id}/signals", "runSignals",
      "Read the measured and simulated signals of one trial of a run; each point states the "
      "smallest and largest value of its samples; regions state the times in each error region",
      "RunSignals", signals);
  for (Parameter p :
       {required_text("trial", "Id of the trial in the measurement set"),
        required_text("channel", "Name of the channel, for example fz_N"),
        optional_text("side",
                      "Model: before = the first model, after = the second or improved model"),
        numeric("from_s", Kind::number, "s",
                "Start of the time range, in seconds since the start of the trial", 0, kLongest_s,
                "0"),
        numeric("to_s", Kind::number, "s",
                "End of the time range, in seconds since the start of the trial", 0, kLongest_s,
                "1000000"),
        numeric("points", Kind::integer, "1", "Largest number of points in the answer", 1, 20000,
                "1000")})
    out.parameters.push_back(std::move(p));
  out.parameters[3].fallback = "before";
  const Json spans = tuple(number("s", "Time since the start of the trial, in seconds"), 2,
                           "Start and end of a time range, in seconds");
  const Json both =
      object({{"min", array(number("its channel's", "Smallest value of the point's samples"),
                            "Smallest value at each point")},
              {"max", array(number("its channel's", "Largest value of the point's samples"),
                            "Largest value at each point")}});
  out.schemas = {
      {"RunSignals",
       object({{"trial", text("Id of the trial in the measurement set")},
               {"channel", text("Name of the channel")},
               {"side",
                one_of({"before", "after"},
                       "Model: before = the first model, after = the second or improved model")},
               {"duration_s", number("s", "Duration of the trial, in seconds")},
               {"t_s", array(number("s", "Time since the start of the trial, in seconds"),
                             "Time of each point, in seconds")},
               {"measured", both},
               {"simulated", both},
               {"residual", both},
               {"noise_floor", number("its channel's",
                                      "Noise floor: root mean square of the residual of a true "
                                      "model, in the channel's unit")},
               {"samples_per_point", integer("1", "Number of samples that each point summarises")},
               {"regions",
                array(array(spans, "Time ranges in the region, in order of time"),
                      "One list of time ranges for each error region of the comparison")}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> lab_runs_routes() {
  using namespace schema;
  RouteInfo list = lab_route("GET", "runs", "labRuns",
                             "List the runs of the lab, newest first, without their results",
                             "LabRunList", list_runs);
  list.parameters = {
      optional_text("kind", "Only runs of this kind: diagnosis, comparison or fit"),
      optional_text("model", "Only runs of the model version with this id"),
      optional_text("measurements", "Only runs with the measurement set with this id"),
      numeric("limit", Parameter::Kind::integer, "1", "Largest number of runs in the answer", 1,
              500, "50")};
  list.schemas = lab_run_schemas();
  list.schemas.push_back(
      {"LabRunList", object({{"runs", array(ref("LabRun"), "Runs, newest first")}})});
  std::vector<RouteInfo> out = asking_routes();
  out.push_back(std::move(list));
  out.push_back(lab_route("GET", "runs/{id}", "labRun",
                          "Read the state of a lab run and its results", "LabRun", one_run));
  out.push_back(lab_route("POST", "runs/{id}/stop", "stopLabRun",
                          "Stop a lab run; a run that has ended stays unchanged", "LabRun",
                          stop_run));
  out.push_back(lab_route("GET", "runs/{id}/report", "labRunReport",
                          "Read the report of a finished lab run as an HTML page", kBytes,
                          report_of));
  out.push_back(lab_route("GET", "runs/{id}/model", "labRunModel",
                          "Read the file of the model that a lab run made", "ModelFile",
                          better_model));
  out.push_back(taking(
      lab_route("POST", "runs/{id}/publish", "publishLabRun",
                "Publish the model of a lab run as a new version, whose parent is the run's first "
                "model; a second call answers with the same version",
                "ModelVersion", publish_run),
      "PublishWanted", kMaxLabRunsAsk_bytes,
      {{"PublishWanted",
        object(
            {{"name", schema::optional(text(
                          "Name of the new version; if it is missing, the model keeps its name"))},
             {"note", schema::optional(text("Note about the purpose of the version"))}})}}));
  out.push_back(signals_route());
  return out;
}

}  // namespace api
}  // namespace tractus
