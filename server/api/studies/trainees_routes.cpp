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
  // The recommendation names a scenario. A trainee must not see it, because the next trial is
  // blinded.
  if (call.of == Scope::own) out["next"] = {{"scenario", ""}, {"why", ""}};
  return json_response(out);
}

Parameter study_parameter() {
  return {.in = Parameter::In::query,
          .name = "study",
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = "Only trials of the study with this id",
          .required = false,
          .fallback = std::nullopt};
}

std::vector<Field> standing_fields() {
  return {
      {"trainee", text("Name of the trainee: name of the account, pseudonym in a study, or name of "
                       "the operator")},
      {"trials", integer("1", "Number of trials that count and have an answer and a truth")},
      {"right", integer("1", "Number of these trials with a correct answer")},
      {"share", number("1", "Share of correct answers, 0 to 1")},
      {"wilson_low", number("1", "Lower end of the 95 % Wilson interval of the share, 0 to 1")},
      {"wilson_high", number("1", "Upper end of the 95 % Wilson interval of the share, 0 to 1")},
      {"state",
       one_of({"learning", "competent", "relapsed"},
              "State of the trainee: LC-CUSUM signals competence, then CUSUM signals relapse, "
              "which ends where its sum is back at 0")},
      {"certified", truth("True if the trainee can be certified as competent")},
      {"why", text("Reason why the trainee can or cannot be certified")},
      {"next",
       object({{"scenario", text("Recommended next scenario; empty in the answer to a trainee, "
                                 "because the next trial is blinded")},
               {"why", text("Reason for the recommendation; empty in the answer to a trainee")}})},
      {"simulated", truth("True if a simulated hand did some of the trials")},
      {"last_utc_us",
       integer("us", "Time of the last trial, in microseconds since 1970-01-01 UTC")}};
}

std::vector<NamedSchema> list_schemas() {
  return {
      {"TraineeSummary", object(standing_fields())},
      {"CertificationRule",
       object({{"adequate", number("1", "Failure rate of adequate performance, 0 to 1")},
               {"inadequate", number("1", "Failure rate of inadequate performance, 0 to 1")},
               {"trials", integer("1",
                                  "Smallest number of trials after which certification is "
                                  "possible; 0 if it is not possible within 400 trials")},
               {"threshold",
                number("1", "Threshold of the LC-CUSUM sum at which competence is signalled")},
               {"relapse", number("1", "Threshold of the CUSUM sum at which relapse is signalled")},
               {"version", integer("1",
                                   "Version of the programme's criteria, counted from 1; "
                                   "0 if the programme has stated none")},
               {"requirements", array(text("A requirement in words"),
                                      "What passing is, all of which must be met")}})},
      {"TraineeList",
       object({{"rule", ref("CertificationRule")},
               {"trainees", array(ref("TraineeSummary"), "Trainees, sorted by name")}})}};
}

std::vector<NamedSchema> one_schemas() {
  auto fields = standing_fields();
  fields.push_back({"rule", ref("CertificationRule")});
  fields.push_back({"competent_at_trial",
                    nullable(integer("1",
                                     "Number of the trial at which competence was signalled, "
                                     "counted from 1; null if it was not signalled"))});
  fields.push_back({"relapses", array(ref("Relapse"), "Relapses, in order of time")});
  fields.push_back({"scenarios", array(ref("ScenarioResult"), "Results by scenario")});
  fields.push_back({"scores", array(ref("ScoreCurve"), "Learning curves by score")});
  fields.push_back({"attempts", array(ref("Attempt"), "Trials of the trainee, in order of time")});
  fields.push_back(
      {"calibration",
       array(ref("CalibrationBin"),
             "Share of correct answers by stated confidence, in ascending order of confidence")});
  return {
      {"Relapse",
       object({{"at_trial", integer("1",
                                    "Number of the trial at which relapse was signalled, "
                                    "counted from 1")},
               {"recovered_at_trial",
                nullable(integer("1",
                                 "Number of the trial at which the CUSUM sum was back at 0, "
                                 "counted from 1; null if it was not yet"))}})},
      {"Attempt",
       object({{"number", integer("1", "Number of the trial, counted from 1")},
               {"trial", nullable(text("Id of the trial; null while the trial is rated blind"))},
               {"scenario", text("Title of the case or scenario")},
               {"started_utc_us",
                nullable(integer("us",
                                 "Start of the trial, in microseconds since 1970-01-01 UTC; null "
                                 "while the trial is rated blind"))},
               {"correct", truth("True if the answer agrees with the truth")},
               {"confidence",
                nullable(number("1", "Stated confidence, 0 to 1; null if the trainee gave none"))},
               {"sum", number("1", "LC-CUSUM sum after the trial")},
               {"relapse_sum",
                nullable(
                    number("1", "CUSUM sum after the trial; null before competence is signalled"))},
               {"scores", map(nullable(number("unit of the metric",
                                              "Score of the trial; null if "
                                              "the trial has no such score")),
                              "Scores of the trial by metric id")}})},
      {"ScenarioResult",
       object({{"scenario", text("Title of the case or scenario")},
               {"trials", integer("1", "Trials of the trainee on this scenario")},
               {"right", integer("1", "Trials with a correct answer")},
               {"share", optional(number("1", "Share of correct answers; absent without a trial"))},
               {"wilson_low", optional(number("1", "Lower end of the share's 95 % interval"))},
               {"wilson_high", optional(number("1", "Upper end of the share's 95 % interval"))},
               {"verdict", text("What the interval says against the acceptable and unacceptable "
                                "rates of failure")},
               {"last_trial",
                optional(integer("1", "Number of the last trial on this scenario, from 1"))},
               {"may_fail", number("1",
                                   "Failure rate that is exceeded with a probability of 10 %, "
                                   "0 to 1")}})},
      {"ScoreCurve",
       object({{"score", text("Metric id")},
               {"trials", integer("1", "Trials that have this score")},
               {"first", optional(number("1",
                                         "Fitted score of the first trial, as a share of the "
                                         "scenario's mean over the cohort: a in a n^-b"))},
               {"rate", optional(number("1", "Learning rate: b in a n^-b"))},
               {"rate_p", optional(nullable(number("1", "p-value of a rate of 0")))},
               {"share_left_when_trials_double",
                optional(number("1", "Score after twice the trials, as a share: 2^-b"))},
               {"note", optional(text("Why no curve could be fitted"))}})},
      {"CalibrationBin",
       object(
           {{"low", number("1", "Smallest confidence of the bin, 0 to 1")},
            {"high", number("1", "Largest confidence of the bin, 0 to 1")},
            {"stated", number("1", "Mean stated confidence in the bin, 0 to 1")},
            {"trials", integer("1", "Number of answers in the bin")},
            {"right", integer("1", "Number of correct answers in the bin")},
            {"wilson_low",
             number(
                 "1",
                 "Lower end of the 95 % Wilson interval of the share of correct answers, 0 to 1")},
            {"wilson_high", number("1",
                                   "Upper end of the 95 % Wilson interval of the share of correct "
                                   "answers, 0 to 1")}})},
      {"Trainee", object(fields)}};
}

}  // namespace

std::vector<RouteInfo> trainees_routes() {
  return {{.method = "GET",
           .path = "/api/v1/cohort/trainees",
           .id = "trainees",
           .summary =
               "List the trainees with their learning state, computed from the trials that count",
           .who = {Role::admin, Role::director, {Role::faculty, Scope::cohort}},
           .parameters = {study_parameter()},
           .body = "",
           .answer = "TraineeList",
           .schemas = list_schemas(),
           .handle = list_trainees},
          {.method = "GET",
           .path = "/api/v1/cohort/trainees/{name}",
           .id = "trainee",
           .summary = "Read one trainee's results: every trial, the LC-CUSUM, results by scenario, "
                      "and the calibration of confidence",
           .who = {Role::admin,
                   Role::director,
                   {Role::faculty, Scope::cohort},
                   {Role::trainee, Scope::own}},
           .parameters = {path_text("name", "Name of the trainee, from the list of trainees"),
                          study_parameter()},
           .body = "",
           .answer = "Trainee",
           .schemas = one_schemas(),
           .handle = one_trainee}};
}

}  // namespace api
}  // namespace tractus
