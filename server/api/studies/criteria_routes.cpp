/// What passing is: stated by the programme in versions, with bounds from experts' trials; and who
/// has passed.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "metrics/metric.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/criteria_json.hpp"
#include "server/api/studies/passing.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using store::CriteriaKind;

constexpr std::uint64_t kMaxCriteria_bytes = 1u << 16;
constexpr std::size_t kMaxReason = 500;

Result<Json> version_json(const store::CriteriaVersion& of) {
  const auto read =
      TRY(assessment::Criteria::from_json(core::stored_json(of.definition), "criteria"));
  return Json{{"version", of.version},
              {"requirements", requirements_json(read)},
              {"reason", of.reason},
              {"made_utc_us", of.made_utc_us},
              {"made_by", of.made_by}};
}

Result<http::Response> list_criteria(const Call& call) {
  const auto rows =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_criteria(tx); }));
  Json list = Json::array();
  for (const store::CriteriaVersion& row : rows) {
    const bool same = !list.empty() && list.back()["kind"] == name(row.kind) &&
                      list.back()["subject"] == row.subject;
    if (!same)
      list.push_back({{"kind", name(row.kind)},
                      {"subject", row.subject},
                      {"title", row.title},
                      {"versions", Json::array()}});
    const auto version = TRY(version_json(row));
    list.back()["versions"].push_back(version);
  }
  return json_response(
      {{"criteria", list}, {"usual", requirements_json(assessment::Criteria::usual())}});
}

Result<store::CriteriaVersion> criteria_asked(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::CriteriaVersion out;
  const std::string of_case = fields.text_or("case", "", 64),
                    assignment = fields.text_or("assignment", "", 64);
  out.reason = fields.text_or("reason", "", kMaxReason);
  const Json* criteria = fields.member("criteria");
  if (!of_case.empty() && !assignment.empty())
    fields.wrong("assignment", "either a case or an assignment is expected");
  TRY(fields.done());
  const auto read = TRY(assessment::Criteria::from_json(*criteria, "body: /criteria"));
  out.definition = read.to_json().dump();
  out.subject = of_case + assignment;
  if (!of_case.empty()) out.kind = CriteriaKind::of_case;
  if (!assignment.empty()) out.kind = CriteriaKind::assignment;
  out.made_utc_us = call.backend.now_utc_us();
  out.made_by = call.caller.name;
  return out;
}

Result<void> check_subject(store::Reading& tx, const Call& call, const store::CriteriaVersion& of) {
  if (of.kind == CriteriaKind::programme && call.caller.role == Role::faculty)
    return Error{Errc::forbidden,
                 "the criteria of the whole programme are for a director to set: name a case or an "
                 "assignment"};
  if (of.kind == CriteriaKind::assignment) TRY(store::find_assignment(tx, of.subject));
  if (of.kind != CriteriaKind::of_case) return {};
  const auto known = TRY(store::case_of(tx, of.subject));
  return known ? Result<void>() : absent("case", of.subject);
}

Result<http::Response> add_criteria_route(const Call& call) {
  const auto asked = TRY(criteria_asked(call));
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check_subject(tx, call, asked));
    return store::add_criteria(tx, asked);
  }));
  return list_criteria(call);
}

/// Each person's trials by the account's name, in the order of time.
using TrialsByPerson = std::map<std::string, std::vector<store::CohortTrial>>;

TrialsByPerson by_person(std::vector<store::CohortTrial> trials) {
  TrialsByPerson out;
  for (store::CohortTrial& trial : trials)
    if (!trial.person.empty()) out[trial.person].push_back(std::move(trial));
  return out;
}

Json passing_json(const CriteriaHistory& history, const TrialsByPerson& people) {
  Json list = Json::array();
  for (const auto& [person, trials] : people) {
    const std::int64_t began = trials.front().summary.started_utc_us;
    std::vector<assessment::JudgedTrial> judged;
    for (const auto& trial : trials) judged.push_back(judged_trial(trial));
    const auto verdict = assessment::judge(history.for_start(began), judged);
    Json one{{"name", person}, {"version", history.number_for(began)}};
    one.update(assessment::verdict_json(verdict));
    one["passed_utc_us"] =
        verdict.passed() ? Json(trials[verdict.passed_at - 1].summary.started_utc_us) : Json();
    one["simulated"] =
        std::ranges::any_of(trials, [](const auto& trial) { return trial.summary.simulated; });
    list.push_back(std::move(one));
  }
  return {{"versions", history.versions.size()}, {"people", list}};
}

Result<http::Response> passing_of_assignment(const Call& call) {
  const auto json = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto id = TRY(store::find_assignment(tx, call.text("id")));
    const auto history = TRY(criteria_history(tx, CriteriaKind::assignment, id.text()));
    auto trials = TRY(store::trials_for_teaching(tx, id.text(), {}, 20'000));
    std::erase_if(trials, [](const auto& trial) { return !counts_for_passing(trial); });
    return passing_json(history, by_person(std::move(trials)));
  }));
  return json_response(json);
}

Result<http::Response> passing_of_case(const Call& call) {
  const auto json = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto history = TRY(criteria_history(tx, CriteriaKind::of_case, call.text("id")));
    auto trials = TRY(trials_for_passing(tx, call, ""));
    std::erase_if(trials,
                  [&](const auto& trial) { return trial.summary.case_id != call.text("id"); });
    return passing_json(history, by_person(std::move(trials)));
  }));
  return json_response(json);
}

enum class BoundMethod { mean_sd, percentile, youden };
constexpr auto words(BoundMethod) {
  using enum BoundMethod;
  return std::to_array<core::Word<BoundMethod>>(
      {{mean_sd, "mean_sd"}, {percentile, "percentile"}, {youden, "youden"}});
}

/// A metric's values of the people of a cohort.
struct GroupValues {
  std::vector<double> values;
  std::set<std::string> people;
  bool simulated = false;
  std::string cohort;
  statistics::Vector vector() const {
    return Eigen::Map<const statistics::Vector>(values.data(), std::ssize(values));
  }
};

Result<GroupValues> values_of_cohort(store::Reading& tx, const Call& call, const char* parameter,
                                     const std::vector<store::CohortTrial>& trials) {
  GroupValues out;
  if (!call.has(parameter)) return out;
  const auto cohort = TRY(store::cohort_of(tx, call.text(parameter)));
  if (!cohort) return absent("cohort", call.text(parameter));
  out.cohort = cohort->name;
  std::set<std::string> names;
  const auto members = TRY(store::people_of(tx, cohort->id));
  for (const auto& person : members)
    if (person.part == store::CohortPart::trainee) names.insert(person.name);
  for (const store::CohortTrial& trial : trials) {
    if (!names.contains(trial.person)) continue;
    if (call.has("case") && trial.summary.case_id != call.text("case")) continue;
    const auto value = trial.metrics.find(call.text("metric"));
    if (value == trial.metrics.end()) continue;
    out.values.push_back(value->second);
    out.people.insert(trial.person);
    out.simulated = out.simulated || trial.summary.simulated;
  }
  return out;
}

Json group_json(const GroupValues& of) {
  return {{"cohort", of.cohort},
          {"people", of.people.size()},
          {"simulated", of.simulated},
          {"values", of.values}};
}

std::string counted(const GroupValues& of, const char* who) {
  return fmt::format("{} trials of {} {} in '{}'", of.values.size(), of.people.size(), who,
                     of.cohort);
}

Result<Json> bound_json(const Call& call, const GroupValues& experts, const GroupValues& novices) {
  const auto method = core::from_name<BoundMethod>(call.text("method"));
  const auto side = core::from_name<assessment::Side>(call.text("side"));
  if (!method || !side)
    return core::bad_input(
        "method: mean_sd, percentile or youden, and side: at_most or at_least "
        "are expected");
  if (experts.values.empty())
    return Error{Errc::bad_input, "experts: no trial of this cohort has this metric"};
  Json out{{"experts", group_json(experts)}, {"novices", group_json(novices)}};
  if (*method == BoundMethod::youden) {
    const auto passing = *side == assessment::Side::at_most ? statistics::Passing::at_most
                                                            : statistics::Passing::at_least;
    const auto cut = TRY(statistics::youden_cut(experts.vector(), novices.vector(), passing));
    out.update(
        Json{{"bound", cut.bound},
             {"sensitivity", cut.sensitivity},
             {"specificity", cut.specificity},
             {"area", cut.area},
             {"basis",
              fmt::format("cut with the greatest Youden index ({:.2f}) between {} and {}",
                          cut.youden, counted(experts, "experts"), counted(novices, "novices"))}});
    return out;
  }
  const bool mean = *method == BoundMethod::mean_sd;
  const double bound = TRY(mean ? statistics::mean_bound(experts.vector(), call.number("k"))
                                : statistics::percentile(experts.vector(), call.number("share")));
  const std::string how = mean ? fmt::format("mean {:+.3g} SD", call.number("k"))
                               : fmt::format("{:.4g} % point", 100.0 * call.number("share"));
  out.update(Json{{"bound", bound},
                  {"sensitivity", nullptr},
                  {"specificity", nullptr},
                  {"area", nullptr},
                  {"basis", how + " of " + counted(experts, "experts")}});
  return out;
}

Result<http::Response> expert_bound(const Call& call) {
  const auto known = metrics::all();
  if (std::ranges::find(known, call.text("metric"), &metrics::MetricInfo::id) == known.end())
    return core::bad_input("metric: there is no such metric");
  const auto json = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto trials = TRY(trials_for_passing(tx, call, ""));
    const auto experts = TRY(values_of_cohort(tx, call, "experts", trials));
    const auto novices = TRY(values_of_cohort(tx, call, "novices", trials));
    return bound_json(call, experts, novices);
  }));
  return json_response(json);
}

std::vector<Grant> teachers() {
  return {Role::admin, Role::director, {Role::faculty, Scope::cohort}};
}

RouteInfo criteria_route(std::string method, std::string path, std::string id, std::string summary,
                         std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = teachers(),
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

std::vector<NamedSchema> listed_schemas() {
  using namespace schema;
  return {{"CriteriaFile", criteria_file_schema()},
          {"Requirement", requirement_schema()},
          {"CriteriaVersion",
           object({{"version", integer("1", "Number of the version, counted from 1")},
                   {"requirements",
                    array(ref("Requirement"), "Requirements, all of which must be met")},
                   {"reason", text("Reason of the change; empty if none was given")},
                   {"made_utc_us", integer("us",
                                           "Time of creation, in microseconds since 1970-01-01 "
                                           "UTC")},
                   {"made_by", text("Name of the account that stated it")}})},
          {"CriteriaEntry",
           object({{"kind", one_of<CriteriaKind>("What the criteria are of")},
                   {"subject", text("Id of the case or the assignment; empty for the programme")},
                   {"title", text("Title of the case or the assignment; empty for the programme")},
                   {"versions", array(ref("CriteriaVersion"), "Versions, oldest first")}})},
          {"CriteriaList",
           object({{"criteria", array(ref("CriteriaEntry"), "Criteria by what they are of")},
                   {"usual",
                    array(ref("Requirement"), "Requirements that hold where none are stated")}})}};
}

std::vector<NamedSchema> passing_schemas() {
  using namespace schema;
  auto fields = verdict_fields();
  fields.insert(fields.begin(),
                {{"name", text("Name of the account")},
                 {"version", integer("1",
                                     "Version of the criteria that holds for the person; 0: "
                                     "the usual ones")}});
  fields.push_back(
      {"passed_utc_us", nullable(integer("us",
                                         "Start of the trial with which the person passed, in "
                                         "microseconds since 1970-01-01 UTC; null if not "
                                         "passed"))});
  fields.push_back({"simulated", truth("True if a simulated hand did some of the trials")});
  return {{"JudgedRequirement", judged_requirement_schema()},
          {"PersonPassing", object(fields)},
          {"Passing",
           object({{"versions", integer("1", "Number of versions of the criteria; 0: none stated")},
                   {"people", array(ref("PersonPassing"), "People with trials, by name")}})}};
}

Parameter text_argument(std::string name, std::string meaning, bool required) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = required,
          .fallback = std::nullopt};
}
Parameter number_argument(std::string name, std::string meaning, double low, double high,
                          std::string fallback) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::number,
          .unit = "1",
          .meaning = std::move(meaning),
          .required = false,
          .low = low,
          .high = high,
          .fallback = std::move(fallback)};
}

RouteInfo bound_route() {
  using namespace schema;
  RouteInfo out = criteria_route("GET", "criteria/bound", "expertBound",
                                 "Compute a bound for a metric from the trials of experts, or "
                                 "between those of experts and of novices",
                                 "ExpertBound", expert_bound);
  out.parameters = {
      text_argument("metric", "Id of the metric", true),
      text_argument("side", "Side of the bound that passes: at_most or at_least", true),
      text_argument("method", "mean_sd, percentile, or youden: the cut of the ROC curve", true),
      text_argument("experts", "Id of the cohort whose trainees are the experts", true),
      text_argument("novices", "Id of the cohort whose trainees are the novices", false),
      text_argument("case", "Only trials of the case with this id", false),
      number_argument("k", "Standard deviations that are added to the mean, negative to take away",
                      -10.0, 10.0, "2"),
      number_argument("share", "Share of the experts' values below the percentile", 0.0, 1.0,
                      "0.9")};
  out.ends = {{"experts", Object::cohort, teachers()}, {"novices", Object::cohort, teachers()}};
  out.schemas = {
      {"BoundGroup",
       object({{"cohort", text("Name of the cohort; empty if none was named")},
               {"people", integer("1", "Number of people with such trials")},
               {"simulated", truth("True if a simulated hand did some of the trials")},
               {"values", array(number("1", "Value of the metric, in its unit"),
                                "One value for each trial, in the order of time")}})},
      {"ExpertBound",
       object({{"bound", number("1", "The bound, in the metric's unit")},
               {"basis", text("Where the bound comes from, in words")},
               {"experts", ref("BoundGroup")},
               {"novices", ref("BoundGroup")},
               {"sensitivity", nullable(number("1",
                                               "Share of the experts' values that pass, 0 to "
                                               "1; null for other methods than youden"))},
               {"specificity", nullable(number("1",
                                               "Share of the novices' values that do not "
                                               "pass, 0 to 1; null for other methods"))},
               {"area", nullable(number("1",
                                        "Area under the ROC curve, 0 to 1; null for other "
                                        "methods"))}})}};
  return out;
}

RouteInfo stating_route() {
  using namespace schema;
  RouteInfo out = criteria_route("POST", "criteria", "addCriteria",
                                 "State what passing is, of a case, of an assignment or, without "
                                 "either, of the whole programme; this adds a version",
                                 "CriteriaList", add_criteria_route);
  out.body = "NewCriteria";
  out.body_limit_bytes = kMaxCriteria_bytes;
  out.ends = {{"/case", Object::published_case, {Role::admin, Role::director, Role::faculty}},
              {"/assignment", Object::assignment, teachers()}};
  out.schemas = {
      {"NewCriteria", object({{"case", optional(text("Id of a case"))},
                              {"assignment", optional(text("Id of an assignment"))},
                              {"reason", optional(text("Reason of the change, at most 500 bytes"))},
                              {"criteria", ref("CriteriaFile")}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> criteria_routes() {
  RouteInfo list = criteria_route("GET", "criteria", "criteria",
                                  "List what passing is, of the programme, of cases and of "
                                  "assignments, with all versions",
                                  "CriteriaList", list_criteria);
  list.who = {Role::admin, Role::director, Role::faculty};
  list.schemas = listed_schemas();
  RouteInfo assignment =
      criteria_route("GET", "assignments/{id}/passing", "assignmentPassing",
                     "Read who has passed an assignment", "Passing", passing_of_assignment);
  assignment.object = Object::assignment;
  assignment.parameters = {path_text("id", "Id of the assignment")};
  assignment.schemas = passing_schemas();
  RouteInfo of_case = criteria_route("GET", "cases/{id}/passing", "casePassing",
                                     "Read who has passed a case, of the people whom the caller "
                                     "may see",
                                     "Passing", passing_of_case);
  of_case.parameters = {path_text("id", "Id of the case")};
  return {list, stating_route(), bound_route(), assignment, of_case};
}

}  // namespace api
}  // namespace tractus
