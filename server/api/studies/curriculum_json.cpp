#include "server/api/studies/curriculum_json.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "server/api/access.hpp"
#include "server/api/backend.hpp"
#include "server/api/studies/criteria_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

/// Where somebody stands with one step.
enum class StepState {
  passed,
  open,
  waiting,  ///< for another step
  used_up,  ///< open, not passed, and every planned trial is done
  held,     ///< the results are not released to the person who asks
};
constexpr auto words(StepState) {
  using enum StepState;
  return std::to_array<core::Word<StepState>>({{passed, "passed"},
                                               {open, "open"},
                                               {waiting, "waiting"},
                                               {used_up, "used_up"},
                                               {held, "held"}});
}

StepState state_of_step(const CurriculumPerson& of, std::size_t s, Scope to) {
  const StepRecord& record = of.steps[s];
  const assessment::StepProgress& at = of.progress.steps[s];
  if (to == Scope::own && record.held) return StepState::held;
  if (at.verdict.passed()) return StepState::passed;
  if (!at.open) return StepState::waiting;
  return record.done >= record.planned ? StepState::used_up : StepState::open;
}

/// What a step's verdict rests on: the trials up to the one with which it was passed, or all.
Json rests_on(const StepRecord& record, const assessment::Verdict& verdict) {
  const std::size_t count = verdict.passed() ? verdict.passed_at : record.trials.size();
  if (count == 0)
    return {{"trials", 0}, {"first_utc_us", nullptr}, {"last_utc_us", nullptr}, {"digest", ""}};
  std::string ids;
  for (std::size_t t = 0; t < count; ++t) ids += record.trials[t].trial.id + "\n";
  return {{"trials", count},
          {"first_utc_us", record.started_utc_us.front()},
          {"last_utc_us", record.started_utc_us[count - 1]},
          {"digest", core::sha256(core::bytes_of(ids))}};
}

Json step_json(const CurriculumPerson& of, std::size_t s, Scope to) {
  const auto& step = of.curriculum.steps[s];
  const StepRecord& record = of.steps[s];
  const StepState state = state_of_step(of, s, to);
  assessment::Verdict verdict = of.progress.steps[s].verdict;
  if (state == StepState::held) verdict = assessment::judge(step.criteria, {});
  Json out{{"id", step.id},
           {"name", step.name},
           {"state", name(state)},
           {"done", record.done},
           {"planned", record.planned},
           {"assignments", record.study_ids},
           {"rests_on", rests_on(state == StepState::held ? StepRecord{} : record, verdict)}};
  out.update(assessment::verdict_json(verdict));
  return out;
}

Json where_json(const CurriculumPerson& of, Scope to,
                const std::map<std::string, std::string>& titles) {
  Json steps = Json::array();
  bool simulated = false, held = false;
  std::int64_t passed_utc_us = 0;
  for (std::size_t s = 0; s < of.steps.size(); ++s) {
    steps.push_back(step_json(of, s, to));
    simulated = simulated || of.steps[s].simulated;
    held = held || steps.back()["state"] == "held";
    const Json& last = steps.back()["rests_on"]["last_utc_us"];
    if (last.is_number()) passed_utc_us = std::max(passed_utc_us, last.get<std::int64_t>());
  }
  const bool passed = of.progress.passed && !held;
  Json next;
  if (of.progress.next_step) {
    const auto title = titles.find(of.progress.next_case);
    // The next trial is blinded for the trainee.
    const bool told = to != Scope::own && title != titles.end();
    next = {{"step", of.curriculum.steps[*of.progress.next_step].id},
            {"case", told ? Json(title->second) : Json()}};
  }
  return {{"account_id", of.account_id},
          {"name", of.name},
          {"curriculum_id", of.curriculum_id},
          {"title", of.title},
          {"version", of.version},
          {"passed", passed},
          {"passed_utc_us", passed ? Json(passed_utc_us) : Json()},
          {"simulated", simulated},
          {"next", next},
          {"steps", steps}};
}

}  // namespace

Result<Json> curriculum_people_json(store::Reading& tx, const Call& call,
                                    const std::string& account_id,
                                    const std::string& curriculum_id) {
  const auto people = TRY(people_in_curricula(tx, account_id, curriculum_id));
  Json list = Json::array();
  for (const CurriculumPerson& person : people) {
    const auto taught = TRY(relates(tx, call.caller, call.of, Object::account, person.account_id));
    if (!taught) continue;
    std::map<std::string, std::string> titles;
    if (!person.progress.next_case.empty()) {
      const auto of = TRY(store::case_of(tx, person.progress.next_case));
      if (of) titles[of->id] = of->title;
    }
    list.push_back(where_json(person, call.of, titles));
  }
  return Json{{"people", list}};
}

std::vector<NamedSchema> curriculum_people_schemas() {
  using namespace schema;
  auto step = verdict_fields();
  step.insert(step.begin(),
              {{"id", text("Id of the step")},
               {"name", text("Name of the step")},
               {"state", one_of<StepState>("Where the person stands; used_up: all planned trials "
                                           "are done without passing; held: the results are not "
                                           "released to the person")},
               {"done", integer("1", "Number of trials that count")},
               {"planned", integer("1", "Number of planned trials")},
               {"assignments", array(text("Id of an assignment"),
                                     "Assignments that hand the step out to the person")},
               {"rests_on", ref("RestsOn")}});
  return {
      {"RestsOn",
       object({{"trials", integer("1", "Number of trials that the verdict rests on")},
               {"first_utc_us", nullable(integer("us",
                                                 "Start of the first of them, in microseconds "
                                                 "since 1970-01-01 UTC; null for none"))},
               {"last_utc_us", nullable(integer("us",
                                                "Start of the last of them, in microseconds "
                                                "since 1970-01-01 UTC; null for none"))},
               {"digest", text("SHA-256 of their ids, each with a line feed, in the order of time; "
                               "empty for none")}})},
      {"StepProgress", object(step)},
      {"CurriculumNext",
       object(
           {{"step", text("Id of the first step that is open and not passed")},
            {"case", nullable(text("Title of its case whose failure rate may be highest; null in "
                                   "the answer to a trainee, because the next trial is "
                                   "blinded"))}})},
      {"CurriculumProgress",
       object({{"account_id", text("Id of the person's account")},
               {"name", text("Name of the account")},
               {"curriculum_id", text("Id of the curriculum")},
               {"title", text("Title of the curriculum")},
               {"version", integer("1", "Version of the curriculum that holds for the person")},
               {"passed", truth("True if all steps are passed")},
               {"passed_utc_us", nullable(integer("us",
                                                  "Start of the last trial that the pass "
                                                  "rests on, in microseconds since "
                                                  "1970-01-01 UTC; null if not passed"))},
               {"simulated", truth("True if a simulated hand did some of the trials")},
               {"next", nullable(ref("CurriculumNext"))},
               {"steps", array(ref("StepProgress"), "Steps, in order")}})},
      {"CurriculumPeople",
       object({{"people", array(ref("CurriculumProgress"), "People in curricula, by name")}})}};
}

}  // namespace api
}  // namespace tractus
