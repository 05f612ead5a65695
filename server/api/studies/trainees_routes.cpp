/// Trainees: how far each is, by the trials that count.
#include <algorithm>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/trainees.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

core::Result<http::Response> list_trainees(const Call& call) {
  const auto programme = TRY(programme_of(call));
  return json_response(list_json(programme));
}

core::Result<http::Response> one_trainee(const Call& call) {
  const auto programme = TRY(programme_of(call));
  const auto& names = programme.cohort.trainees;
  const auto at = std::ranges::find(names, call.text("name"));
  if (at == names.end())
    return core::Error{core::Errc::not_found,
                       "no scored trials of " + call.text("name").substr(0, 64)};
  core::Json out = trainee_json(programme, std::size_t(at - names.begin()));
  // What would be best to do next names a scenario: a trainee who waits for a blind trial is not
  // told one.
  if (call.of == Scope::own) out["next"] = {{"scenario", ""}, {"why", ""}};
  return json_response(out);
}

Parameter study_parameter() {
  return {.in = Parameter::In::query,
          .name = "study",
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = "trials of this study alone",
          .required = false,
          .fallback = std::nullopt};
}

std::vector<Field> standing_fields() {
  return {{"trainee", text("the account's name, a study's pseudonym, or the operator's name")},
          {"trials", integer("1", "that count and are judged")},
          {"right", integer("1", "of them")},
          {"share", number("1", "right, of all")},
          {"wilson_low", number("1", "95 % interval of the share")},
          {"wilson_high", number("1", "95 % interval of the share")},
          {"state", one_of({"learning", "competent", "relapsed"}, "by LC-CUSUM, then CUSUM")},
          {"certified", truth("competence can be said")},
          {"why", text("why it can, or cannot")},
          {"next", object({{"scenario", text("to do next; empty for the trainee, who is blind")},
                           {"why", text("that one")}})},
          {"simulated", truth("some of the trials are by a machine")},
          {"last_utc_us", integer("us", "of the last trial, since 1970, UTC")}};
}

std::vector<NamedSchema> list_schemas() {
  return {{"TraineeSummary", object(standing_fields())},
          {"CertificationRule",
           object({{"adequate", number("1", "failure rate of adequate performance")},
                   {"inadequate", number("1", "failure rate of inadequate performance")},
                   {"trials", integer("1", "the fewest that can certify; 0: none within 400")},
                   {"threshold", number("1", "sum at which competence is signalled")},
                   {"relapse", number("1", "sum at which relapse is signalled")}})},
          {"TraineeList", object({{"rule", ref("CertificationRule")},
                                  {"trainees", array(ref("TraineeSummary"), "by name")}})}};
}

std::vector<NamedSchema> one_schemas() {
  auto fields = standing_fields();
  fields.push_back({"rule", ref("CertificationRule")});
  fields.push_back({"competent_at_trial", nullable(integer("1", "from 1"))});
  fields.push_back({"relapse_at_trial", nullable(integer("1", "from 1"))});
  fields.push_back({"scenarios", array(anything("share right, with its interval"), "by scenario")});
  fields.push_back({"scores", array(anything("its learning curve"), "by score")});
  fields.push_back({"attempts", array(ref("Attempt"), "in order")});
  fields.push_back({"calibration", array(ref("CalibrationBin"), "by stated confidence, rising")});
  return {
      {"Attempt", object({{"number", integer("1", "from 1")},
                          {"trial", text("id")},
                          {"scenario", text("its case")},
                          {"started_utc_us", integer("us", "since 1970, UTC")},
                          {"correct", truth("the answer was right")},
                          {"confidence", nullable(number("1", "as stated with the answer"))},
                          {"sum", number("1", "of the LC-CUSUM after it")},
                          {"relapse_sum", nullable(number("1", "of the CUSUM after the signal"))},
                          {"scores", anything("value, or null, by metric id")}})},
      {"CalibrationBin", object({{"low", number("1", "least confidence in it")},
                                 {"high", number("1", "most")},
                                 {"stated", number("1", "mean confidence")},
                                 {"trials", integer("1", "answers in it")},
                                 {"right", integer("1", "of them")},
                                 {"wilson_low", number("1", "95 % interval of the share right")},
                                 {"wilson_high", number("1", "of it")}})},
      {"Trainee", object(fields)}};
}

}  // namespace

std::vector<RouteInfo> trainees_routes() {
  return {{.method = "GET",
           .path = "/api/v1/cohort/trainees",
           .id = "trainees",
           .summary = "How far each trainee is, by the trials that count",
           .who = {Role::admin, Role::director, {Role::faculty, Scope::cohort}},
           .parameters = {study_parameter()},
           .body = "",
           .answer = "TraineeList",
           .schemas = list_schemas(),
           .handle = list_trainees},
          {.method = "GET",
           .path = "/api/v1/cohort/trainees/{name}",
           .id = "trainee",
           .summary = "One trainee: trial by trial, LC-CUSUM, scenarios, confidence",
           .who = {Role::admin,
                   Role::director,
                   {Role::faculty, Scope::cohort},
                   {Role::trainee, Scope::own}},
           .parameters = {path_text("name", "as in the list"), study_parameter()},
           .body = "",
           .answer = "Trainee",
           .schemas = one_schemas(),
           .handle = one_trainee}};
}

}  // namespace api
}  // namespace tractus
