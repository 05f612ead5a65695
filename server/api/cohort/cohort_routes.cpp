/// A cohort: its scored trials as a table, locked plans, and analyses of it as jobs.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/cohort/analyses.hpp"
#include "server/api/cohort/analysis_file_schemas.hpp"
#include "server/api/cohort/cohort_questions.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/jobs/cohort_table.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using namespace schema;

constexpr std::uint64_t kMaxCohortAsk_bytes = 16384, kMaxCohortPlan_bytes = 1 << 20;
constexpr std::int64_t kMostInTable = 20'000;

Json analysis_summary(const store::AnalysisRun& run) {
  return {{"id", run.id},
          {"plan", core::or_null(run.plan_id)},
          {"study", core::or_null(run.study)},
          {"state", name(run.state)},
          {"share", run.share},
          {"error", run.error},
          {"snapshot", core::or_null(run.snapshot)},
          {"made_utc_us", run.made_utc_us},
          {"made_by", run.made_by}};
}

/// The run with its result, the description of its data, and whether an earlier run gave the same
/// digits.
Result<Json> analysis_json(const Call& call, const store::AnalysisRun& run) {
  Json out = analysis_summary(run);
  for (const auto& [key, object] :
       {std::pair{"data", &run.description}, std::pair{"result", &run.result}}) {
    out[key] = nullptr;
    if (!*object) continue;
    auto read = TRY(core::read_json(TRY(call.backend.objects.file(**object))));
    out[key] = std::move(read);
  }
  const auto before = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::analysis_repeated_by(tx, run); }));
  out["repeats"] = before ? Json(before->id) : Json();
  out["same_digits"] = before && run.result ? Json(before->result == run.result) : Json();
  return out;
}

Json plan_json(const store::AnalysisPlan& plan) {
  return {{"id", plan.id},
          {"title", plan.title},
          {"study", core::or_null(plan.study)},
          {"data_seen", plan.data_seen},
          {"trials_then", plan.trials_then},
          {"made_utc_us", plan.made_utc_us},
          {"made_by", plan.made_by}};
}

Result<http::Response> lock_plan(const Call& call) {
  const auto asked = TRY(core::parse_json(call.request.body, "body"));
  const auto plan = TRY(locked_plan(call.backend, asked, call.caller.name));
  return json_response(plan_json(plan), 201);
}

Result<http::Response> list_plans(const Call& call) {
  const auto plans = TRY(
      call.backend.store.read([](store::Reading& tx) { return store::all_analysis_plans(tx); }));
  Json list = Json::array();
  for (const auto& plan : plans) list.push_back(plan_json(plan));
  return json_response({{"plans", list}});
}

Result<http::Response> plan_of(const Call& call) {
  using Runs = std::vector<store::AnalysisRun>;
  const std::string& id = call.text("id");
  const auto plan = TRY(
      call.backend.store.read([&](store::Reading& tx) { return store::analysis_plan_of(tx, id); }));
  if (!plan) return absent("plan", id);
  const auto runs = TRY(call.backend.store.read(
      [&](store::Reading& tx) -> Result<Runs> { return store::analyses_of_plan(tx, id); }));
  auto file = TRY(core::read_json(TRY(call.backend.objects.file(plan->plan))));
  Json out = plan_json(*plan);
  out["plan"] = std::move(file);
  out["analyses"] = Json::array();
  for (const auto& run : runs) out["analyses"].push_back(analysis_summary(run));
  return json_response(out);
}

Result<http::Response> analyse_cohort(const Call& call) {
  const auto asked = TRY(core::parse_json(call.request.body, "body"));
  const auto run = TRY(queued_analysis(call.backend, asked, call.caller.name));
  call.backend.work_waits();
  return json_response(analysis_summary(run), 201);
}

Result<store::AnalysisRun> analysis_of(const Call& call) {
  const auto run = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::analysis_of(tx, call.text("id")); }));
  if (!run) return absent("analysis", call.text("id"));
  return *run;
}

Result<http::Response> analysis(const Call& call) {
  const auto run = TRY(analysis_of(call));
  const auto json = TRY(analysis_json(call, run));
  return json_response(json);
}

Result<http::Response> stop_analysis(const Call& call) {
  const auto run = TRY(analysis_of(call));
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::end_analysis(tx, run.id, store::AnalysisState::cancelled,
                               "stopped by " + call.caller.name, call.backend.now_utc_us());
  }));
  return json_response(analysis_summary(TRY(analysis_of(call))));
}

/// One file of a finished run.
Result<http::Response> part_of(const Call& call) {
  const auto run = TRY(analysis_of(call));
  const std::string& part = call.text("part");
  if (part == "dictionary.json") {
    if (!run.description || !run.data) return absent("dictionary of the analysis", run.id);
    return dictionary_response(call.backend, run);
  }
  const bool page = part == "report.html", json = part == "result.json";
  if (!page && !json && part != "data.csv") return absent("part of an analysis", part);
  const auto& object = page ? run.report : json ? run.result : run.data;
  if (!object) return absent("finished analysis", run.id);
  if (!page && !json) TRY(check_still_released(call.backend, run.study, *object));
  auto response = http::file_response(TRY(call.backend.objects.file(*object)), call.request,
                                      page   ? "text/html; charset=utf-8"
                                      : json ? "application/json"
                                             : "text/csv; charset=utf-8");
  if (response && page) *response = as_report(std::move(*response));
  if (response && !page)
    response->with("Content-Disposition", fmt::format("attachment; filename=\"{}\"", part));
  return response;
}

Result<http::Response> table_of(const Call& call) {
  const auto released = TRY(call.backend.store.read([&](store::Reading& tx) {
    return store::ReleasedTrials::read(
        tx, call.backend.pseudonym_key,
        {.study = call.has("study") ? call.text("study") : "", .most = kMostInTable});
  }));
  http::Response response{.status = 200, .headers = {}, .body = jobs::cohort_table(released).csv};
  response.with("Content-Type", "text/csv; charset=utf-8")
      .with("Content-Disposition", "attachment; filename=\"cohort.csv\"")
      .with("Cache-Control", "no-store");
  return response;
}

RouteInfo cohort_route(std::string method, std::string tail, std::string id, std::string summary,
                       std::string answer, Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out = research_route(std::move(method), "cohort/" + tail, std::move(id),
                                 std::move(summary), std::move(answer), handle);
  out.who.push_back(Role::director);
  return out;
}

std::vector<Field> locked_plan_fields() {
  return {
      {"id", text("Id of the plan, which never changes")},
      {"title", text("Title of the plan")},
      {"study", nullable(text("Id of the study whose trials the plan uses; null: all trials"))},
      {"data_seen", truth("True if the data could be seen before the plan was locked, so "
                          "that the analysis is not confirmatory")},
      {"trials_then",
       integer("1",
               "Number of scored trials for this plan on this server when the plan was locked")},
      {"made_utc_us",
       integer("us", "Time when the plan was locked, in microseconds since 1970-01-01 UTC")},
      {"made_by", text("Name of the account that locked the plan")}};
}

std::vector<Field> analysis_fields() {
  return {
      {"id", text("Id of the analysis")},
      {"plan", nullable(text("Id of the locked plan; null for an analysis without a plan"))},
      {"study", nullable(text("Id of the study; null: all trials"))},
      {"state", one_of<store::AnalysisState>("State of the analysis")},
      {"share", number("1", "Completed share of the work, 0 to 1")},
      {"error", text("Reason for the failure, or who stopped the analysis; otherwise empty")},
      {"snapshot", nullable(text("SHA-256 of the frozen data; null until the data are frozen"))},
      {"made_utc_us", integer("us", "Time of the request, in microseconds since 1970-01-01 UTC")},
      {"made_by", text("Name of the account that requested the analysis")}};
}

std::vector<NamedSchema> plan_schemas() {
  std::vector<Field> whole = locked_plan_fields();
  whole.emplace_back("plan", ref("PlanFile"));
  whole.emplace_back("analyses",
                     array(ref("CohortAnalysis"), "Analyses with the plan, newest first"));
  std::vector<NamedSchema> out = plan_file_schemas();
  out.push_back(
      {"PlanToLock",
       object({{"plan", ref("PlanFile")},
               {"study", optional(text("Id of the study; the plan then uses only trials of this "
                                       "study; if it is missing, all trials"))},
               {"data_seen", optional(truth("True if the author already knows the data, so that "
                                            "the analysis is a reanalysis; default false"))}})});
  out.push_back({"LockedPlan", object(locked_plan_fields())});
  out.push_back({"PlanAnswer", object(whole)});
  return out;
}

std::vector<NamedSchema> run_schemas() {
  return {
      {"CohortQuestion",
       object({{"plan", optional(text("Id of a locked plan; give either a plan or a method"))},
               {"snapshot", optional(text("With a plan: SHA-256 of the data of an earlier "
                                          "analysis; if it is missing, the current data"))},
               {"method",
                optional(
                    text("Statistical method of `tractus stats`, for example anova, ols or lmm"))},
               {"formula",
                optional(
                    text("Formula with columns of the cohort table, for example correct ~ level"))},
               {"options", optional(method_options_schema())},
               {"study", optional(text("With a method: id of the study; only trials of this study "
                                       "are analysed; if it is missing, all trials"))}})},
      {"CohortAnalysis", object(analysis_fields())}};
}

std::vector<NamedSchema> answer_schemas() {
  std::vector<Field> fields = analysis_fields();
  fields.emplace_back("data", nullable(ref("Snapshot")));
  fields.emplace_back("result", nullable(ref("AnalysisResult")));
  fields.emplace_back(
      "repeats",
      nullable(
          text("Id of the first analysis of this plan on the same data; null if there is none")));
  fields.emplace_back(
      "same_digits",
      nullable(truth("True if the result equals that of the first analysis to the last "
                     "digit; null if there is no earlier analysis or no result yet")));
  std::vector<NamedSchema> out = analysis_file_schemas();
  out.push_back({"CohortAnswer", object(fields)});
  return out;
}

}  // namespace

std::vector<RouteInfo> cohort_routes() {
  RouteInfo list =
      cohort_route("GET", "plans", "analysisPlans", "List the locked analysis plans, newest first",
                   "PlanList", list_plans);
  list.schemas = {
      {"PlanList", object({{"plans", array(ref("LockedPlan"), "Locked plans, newest first")}})}};
  const RouteInfo one =
      cohort_route("GET", "plans/{id}", "analysisPlan",
                   "Read a locked plan in full, with its analyses", "PlanAnswer", plan_of);
  RouteInfo answered = cohort_route(
      "GET", "analyses/{id}", "cohortAnalysis",
      "Read the state of an analysis and, when it is done, its result", "CohortAnswer", analysis);
  answered.schemas = answer_schemas();
  RouteInfo part = cohort_route("GET", "analyses/{id}/{part}", "cohortAnalysisPart",
                                "Read a file of a finished analysis", kBytes, part_of);
  part.parameters.push_back(
      path_text("part", "Name of the file: report.html, result.json, data.csv or dictionary.json"));
  RouteInfo table =
      cohort_route("GET", "table", "cohortTable",
                   "Export the scored trials as CSV, one row per trial", kBytes, table_of);
  table.parameters = {{.in = Parameter::In::query,
                       .name = "study",
                       .kind = Parameter::Kind::text,
                       .unit = "",
                       .meaning = "Only trials of the study with this id",
                       .required = false,
                       .fallback = std::nullopt}};
  return {
      taking(
          cohort_route("POST", "plans", "lockAnalysisPlan",
                       "Lock an analysis plan before its data are seen", "LockedPlan", lock_plan),
          "PlanToLock", kMaxCohortPlan_bytes, plan_schemas()),
      list,
      one,
      taking(
          cohort_route("POST", "analyses", "analyseCohort",
                       "Queue an analysis of the scored trials, either with a locked plan or with "
                       "one method",
                       "CohortAnalysis", analyse_cohort),
          "CohortQuestion", kMaxCohortAsk_bytes, run_schemas()),
      answered,
      cohort_route("POST", "analyses/{id}/stop", "stopCohortAnalysis",
                   "Stop an analysis that is queued or running; one that is done stays as it is",
                   "CohortAnalysis", stop_analysis),
      part,
      table};
}

}  // namespace api
}  // namespace tractus
