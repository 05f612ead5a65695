#include "assessment/curriculum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

constexpr const char* kCurriculumFormat = "tractus-curriculum/1";
constexpr std::size_t kMostSteps = 20, kMostCases = 64;

/// Texts, none of them twice.
std::vector<std::string> texts_field(core::Fields& fields, const char* key, std::size_t least) {
  std::vector<std::string> out;
  const Json* list = fields.member(key);
  const bool fits = list && list->is_array() && list->size() >= least &&
                    list->size() <= kMostCases &&
                    std::ranges::all_of(*list, [](const Json& one) { return one.is_string(); });
  if (!fits) {
    if (list)
      fields.wrong(key, fmt::format("an array of {} to {} ids is expected", least, kMostCases));
    return out;
  }
  for (const Json& one : *list) {
    out.push_back(one.get<std::string>());
    if (std::ranges::count(out, out.back()) > 1) fields.wrong(key, "an id stands there twice");
  }
  return out;
}

core::Result<CurriculumStep> step_from(const Json& json, const std::string& where,
                                       const std::set<std::string>& earlier) {
  core::Fields fields(json, where);
  CurriculumStep out;
  out.id = fields.text("id", 32);
  if (earlier.contains(out.id))
    fields.wrong("id", "a step has this id already: it stands there twice");
  out.name = fields.text("name", 100);
  if (out.name.empty()) fields.wrong("name", "a name is expected");
  out.cases = texts_field(fields, "cases", 1);
  out.repeats = fields.integer_or("repeats", 1, 1, 20);
  out.after = texts_field(fields, "after", 0);
  for (const std::string& id : out.after)
    if (!earlier.contains(id)) fields.wrong("after", "the id of an earlier step is expected");
  const Json* criteria = fields.member("criteria");
  TRY(fields.done());
  out.criteria = TRY(Criteria::from_json(*criteria, where + "/criteria"));
  return out;
}

std::vector<JudgedTrial> judged(const std::vector<StepTrial>& trials) {
  std::vector<JudgedTrial> out;
  for (const StepTrial& one : trials) out.push_back(one.trial);
  return out;
}

std::string next_case_of(const CurriculumStep& step, const std::vector<StepTrial>& trials) {
  std::vector<Tally> tallies(step.cases.size());
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const auto at = std::ranges::find(step.cases, trials[t].case_id);
    if (at == step.cases.end()) continue;
    Tally& own = tallies[std::size_t(at - step.cases.begin())];
    own.last = t + 1;
    if (!trials[t].trial.right) continue;
    own.trials += 1.0;
    own.right += *trials[t].trial.right ? 1.0 : 0.0;
  }
  return step.cases[next_of(tallies)];
}

}  // namespace

core::Result<Curriculum> Curriculum::from_json(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  if (fields.text("format", 64) != kCurriculumFormat)
    fields.wrong("format", std::string(kCurriculumFormat) + " is expected");
  const Json* list = fields.member("steps");
  if (list && (!list->is_array() || list->empty() || list->size() > kMostSteps))
    fields.wrong("steps", fmt::format("an array of 1 to {} steps is expected", kMostSteps));
  TRY(fields.done());
  Curriculum out;
  std::set<std::string> earlier;
  for (const Json& one : *list) {
    auto step = TRY(step_from(one, fmt::format("{}/steps/{}", where, out.steps.size()), earlier));
    earlier.insert(step.id);
    out.steps.push_back(std::move(step));
  }
  return out;
}

Json Curriculum::to_json() const {
  Json list = Json::array();
  for (const CurriculumStep& step : steps)
    list.push_back({{"id", step.id},
                    {"name", step.name},
                    {"cases", step.cases},
                    {"repeats", step.repeats},
                    {"after", step.after},
                    {"criteria", step.criteria.to_json()}});
  return {{"format", kCurriculumFormat}, {"steps", list}};
}

Progress progress(const Curriculum& of, const std::vector<std::vector<StepTrial>>& trials) {
  Progress out;
  std::set<std::string> passed;
  for (std::size_t s = 0; s < of.steps.size(); ++s) {
    const CurriculumStep& step = of.steps[s];
    StepProgress at{.verdict = judge(step.criteria, judged(trials[s]))};
    at.open =
        std::ranges::all_of(step.after, [&](const std::string& id) { return passed.contains(id); });
    if (at.verdict.passed()) passed.insert(step.id);
    if (at.open && !at.verdict.passed() && !out.next_step) {
      out.next_step = s;
      out.next_case = next_case_of(step, trials[s]);
    }
    out.steps.push_back(std::move(at));
  }
  out.passed = passed.size() == of.steps.size();
  return out;
}

}  // namespace assessment
}  // namespace tractus
