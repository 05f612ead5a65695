/// The progress of whole cohorts: recognition by running trial number, who is behind, and who has
/// not come for a while.
#include <algorithm>
#include <cmath>

#include "assessment/cohort_progress.hpp"
#include "core/try.hpp"
#include "db/store/people/people.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"
#include "server/api/studies/trainees.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

using core::Json;
using core::Result;

/// A cohort that the caller may see, with its active trainees.
struct SeenCohort {
  store::Cohort cohort;
  std::vector<store::CohortPerson> trainees;
};

/// Faculty see the cohorts that they lead; who is only a member of one sees nobody in it.
Result<std::vector<SeenCohort>> seen_cohorts(store::Reading& tx, const Call& call) {
  const bool all = call.of == Scope::all;
  const auto cohorts = TRY(store::cohorts_of(tx, all ? "" : call.caller.id));
  std::vector<SeenCohort> out;
  for (const store::Cohort& cohort : cohorts) {
    if (!all && !TRY(store::leads_cohort(tx, call.caller.id, cohort.id))) continue;
    auto people = TRY(store::people_of(tx, cohort.id));
    std::erase_if(people, [](const store::CohortPerson& one) {
      return one.part != store::CohortPart::trainee || one.state != store::AccountState::active;
    });
    out.push_back({cohort, std::move(people)});
  }
  return out;
}

/// The trials of an account, by its place in the programme; nothing if it has none.
std::optional<std::size_t> place_in(const Programme& programme, const std::string& account) {
  const auto& names = programme.cohort.trainees;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == account && std::ranges::any_of(programme.trials[i], [&](const auto& trial) {
          return trial.person == account;
        }))
      return i;
  return std::nullopt;
}

Json ratio_or_null(double value) {
  return std::isfinite(value) ? Json(std::clamp(value, 0.0, 1.0)) : Json();
}

Json bins_json(const std::vector<assessment::Answers>& answers) {
  Json out = Json::array();
  for (const auto& bin : assessment::progress_bins(answers))
    out.push_back({{"from", bin.from},
                   {"to", bin.to},
                   {"trainees", bin.trainees},
                   {"share", bin.share},
                   {"low", ratio_or_null(bin.low)},
                   {"high", ratio_or_null(bin.high)}});
  return out;
}

Json cohort_progress_json(const Programme& programme, const SeenCohort& of) {
  std::vector<assessment::Answers> answers;
  std::vector<std::optional<std::int64_t>> last_utc_us;
  for (const store::CohortPerson& person : of.trainees) {
    assessment::Answers own;
    std::optional<std::int64_t> last;
    if (const auto at = place_in(programme, person.name)) {
      for (const auto& attempt : programme.cohort.attempts[*at]) own.push_back(attempt.right);
      last = programme.trials[*at].back().summary.started_utc_us;
    }
    answers.push_back(std::move(own));
    last_utc_us.push_back(last);
  }
  Json trainees = Json::array();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto pace = assessment::pace_of(answers, i);
    trainees.push_back({{"trainee", of.trainees[i].name},
                        {"trials", answers[i].size()},
                        {"recent_trials", pace.trials},
                        {"recent_right", pace.right},
                        {"others_share", pace.others ? Json(*pace.others) : Json()},
                        {"behind", pace.behind},
                        {"last_utc_us", last_utc_us[i] ? Json(*last_utc_us[i]) : Json()}});
  }
  return {{"id", of.cohort.id},
          {"name", of.cohort.name},
          {"bins", bins_json(answers)},
          {"trainees", trainees}};
}

Result<http::Response> cohort_progress(const Call& call) {
  const auto programme = TRY(programme_of(call));
  const auto cohorts =
      TRY(call.backend.store.read([&](store::Reading& tx) { return seen_cohorts(tx, call); }));
  Json list = Json::array();
  for (const SeenCohort& cohort : cohorts) list.push_back(cohort_progress_json(programme, cohort));
  return json_response({{"cohorts", list}});
}

std::vector<NamedSchema> progress_schemas() {
  return {
      {"ProgressBin",
       object({{"from", integer("1", "First trial of the bin, by the trainee's running number")},
               {"to", integer("1", "Last trial of the bin")},
               {"trainees", integer("1", "Number of trainees who did all trials of the bin")},
               {"share", number("1", "Mean of their shares of correct answers, 0 to 1")},
               {"low", nullable(number("1",
                                       "Lower end of the mean's 95 % interval over trainees, 0 to "
                                       "1; null with a single trainee"))},
               {"high", nullable(number("1",
                                        "Upper end of the mean's 95 % interval over trainees, 0 "
                                        "to 1; null with a single trainee"))}})},
      {"TraineePace",
       object({{"trainee", text("Name of the trainee's account")},
               {"trials", integer("1", "Number of trials that count and have an answer")},
               {"recent_trials", integer("1", "Number of the last trials, at most ten")},
               {"recent_right", integer("1", "Number of these trials with a correct answer")},
               {"others_share",
                nullable(number("1",
                                "Share of correct answers of the other trainees at the same trial "
                                "numbers, 0 to 1; null if nobody else did as many trials"))},
               {"behind", truth("True if the trainee is right less often than the others at the "
                                "same trial numbers: Fisher's exact test, p at most 0.05")},
               {"last_utc_us",
                nullable(integer("us",
                                 "Time of the last trial, in microseconds since 1970-01-01 UTC; "
                                 "null if there is none"))}})},
      {"CohortProgress",
       object({{"id", text("Id of the cohort")},
               {"name", text("Name of the cohort")},
               {"bins", array(ref("ProgressBin"), "Learning curve in bins of five trials")},
               {"trainees",
                array(ref("TraineePace"), "Active trainees of the cohort, sorted by name")}})},
      {"CohortProgressList",
       object({{"cohorts", array(ref("CohortProgress"), "Cohorts, sorted by name")}})}};
}

}  // namespace

std::vector<RouteInfo> progress_routes() {
  return {{.method = "GET",
           .path = "/api/v1/cohort/progress",
           .id = "cohortProgress",
           .summary =
               "Compare cohorts: correct answers by running trial number, who is behind, and "
               "each trainee's last trial",
           .who = {Role::admin, Role::director, {Role::faculty, Scope::cohort}},
           .parameters = {},
           .body = "",
           .answer = "CohortProgressList",
           .schemas = progress_schemas(),
           .handle = cohort_progress}};
}

}  // namespace api
}  // namespace tractus
