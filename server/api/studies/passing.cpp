#include "server/api/studies/passing.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "server/api/backend.hpp"

namespace tractus {
namespace api {
namespace {

using core::Result;

constexpr std::int64_t kMostJudged = 20'000;

const assessment::Criteria& usual_criteria() {
  static const assessment::Criteria usual = assessment::Criteria::usual();
  return usual;
}

using Steps = std::vector<store::CurriculumAssignment>;

/// One version of one curriculum, with the assignments that hand its steps out.
struct VersionSteps {
  store::CurriculumVersion version;
  assessment::Curriculum curriculum;
  Steps steps;
};

Result<VersionSteps> version_steps(store::Reading& tx, Steps steps) {
  const auto versions = TRY(store::curriculum_versions(tx, steps.front().curriculum_id));
  const auto at = std::size_t(steps.front().version - 1);
  if (at >= versions.size())
    return core::Error{core::Errc::corrupt, "an assignment is of a curriculum that is not there"};
  auto curriculum = TRY(
      assessment::Curriculum::from_json(core::stored_json(versions[at].definition), "curriculum"));
  return VersionSteps{versions[at], std::move(curriculum), std::move(steps)};
}

/// By curriculum and version; the rows come in that order.
Result<std::vector<VersionSteps>> grouped(store::Reading& tx, const Steps& rows,
                                          const std::string& curriculum_id) {
  std::vector<VersionSteps> out;
  for (std::size_t i = 0; i < rows.size();) {
    Steps same;
    for (; i < rows.size() && (same.empty() || (rows[i].curriculum_id == same[0].curriculum_id &&
                                                rows[i].version == same[0].version));
         ++i)
      same.push_back(rows[i]);
    if (!curriculum_id.empty() && same[0].curriculum_id != curriculum_id) continue;
    auto group = TRY(version_steps(tx, std::move(same)));
    out.push_back(std::move(group));
  }
  return out;
}

CurriculumPerson& person_among(std::vector<CurriculumPerson>& people, const VersionSteps& of,
                               const store::AssignedPerson& who) {
  const auto at = std::ranges::find_if(people, [&](const CurriculumPerson& one) {
    return one.account_id == who.account_id && one.curriculum_id == of.version.id &&
           one.version == of.version.version;
  });
  if (at != people.end()) return *at;
  CurriculumPerson out{.account_id = who.account_id,
                       .name = who.name,
                       .curriculum_id = of.version.id,
                       .title = of.version.title,
                       .version = of.version.version,
                       .curriculum = of.curriculum};
  out.steps.resize(of.curriculum.steps.size());
  return people.emplace_back(std::move(out));
}

void add_trials(StepRecord& to, const std::vector<store::CohortTrial>& trials,
                const std::string& name) {
  for (const store::CohortTrial& trial : trials) {
    if (trial.person != name || !counts_for_passing(trial)) continue;
    to.trials.push_back({judged_trial(trial), trial.summary.case_id});
    to.started_utc_us.push_back(trial.summary.started_utc_us);
    to.simulated = to.simulated || trial.summary.simulated;
  }
}

/// One assignment's people and trials, into their records.
Result<void> add_assignment_to(store::Reading& tx, std::vector<CurriculumPerson>& people,
                               const VersionSteps& of, const store::CurriculumAssignment& row,
                               const std::string& account_id) {
  const auto step =
      std::ranges::find(of.curriculum.steps, row.step_id, &assessment::CurriculumStep::id);
  if (step == of.curriculum.steps.end()) return {};
  const auto place = std::size_t(step - of.curriculum.steps.begin());
  const auto id = TRY(store::find_assignment(tx, row.study_id));
  const auto assignment = TRY(store::assignment_of(tx, id));
  const auto assigned = TRY(store::assigned_people(tx, id));
  const auto trials = TRY(store::trials_for_teaching(tx, row.study_id, {}, kMostJudged));
  for (const store::AssignedPerson& who : assigned) {
    if (!account_id.empty() && who.account_id != account_id) continue;
    StepRecord& record = person_among(people, of, who).steps[place];
    record.study_ids.push_back(row.study_id);
    record.done += who.done;
    record.planned += who.planned;
    record.held = record.held || assignment.release == store::Release::held;
    add_trials(record, trials, who.name);
  }
  return {};
}

}  // namespace

bool counts_for_passing(const store::CohortTrial& trial) {
  return trial.complete && trial.summary.state == store::AssessmentState::assessed &&
         (trial.study.empty() || trial.place == store::StudyTrialState::counts);
}

assessment::JudgedTrial judged_trial(const store::CohortTrial& trial) {
  return {.id = trial.summary.id, .right = trial.summary.correct, .metrics = trial.metrics};
}

Result<std::vector<store::CohortTrial>> trials_for_passing(store::Reading& tx, const Call& call,
                                                           const std::string& study) {
  store::TrialFilter whose;
  if (call.of == Scope::cohort) whose.taught_by = call.caller.id;
  if (call.of == Scope::own) whose.seen_by = call.caller.id;
  auto trials = TRY(store::trials_for_teaching(tx, study, whose, kMostJudged));
  std::erase_if(trials, [](const auto& trial) { return !counts_for_passing(trial); });
  return trials;
}

const assessment::Criteria& CriteriaHistory::for_start(
    std::optional<std::int64_t> began_utc_us) const {
  if (versions.empty()) return usual_criteria();
  return versions[assessment::version_for(made_utc_us, began_utc_us)];
}

std::size_t CriteriaHistory::number_for(std::optional<std::int64_t> began_utc_us) const {
  return versions.empty() ? 0 : assessment::version_for(made_utc_us, began_utc_us) + 1;
}

Result<CriteriaHistory> criteria_history(store::Reading& tx, store::CriteriaKind kind,
                                         const std::string& subject) {
  CriteriaHistory out;
  const auto stored = TRY(store::criteria_of(tx, kind, subject));
  for (const store::CriteriaVersion& one : stored) {
    auto read = TRY(assessment::Criteria::from_json(core::stored_json(one.definition), "criteria"));
    out.versions.push_back(std::move(read));
    out.made_utc_us.push_back(one.made_utc_us);
  }
  return out;
}

Result<std::vector<CurriculumPerson>> people_in_curricula(store::Reading& tx,
                                                          const std::string& account_id,
                                                          const std::string& curriculum_id) {
  const auto rows = TRY(store::curriculum_assignments(tx, account_id));
  const auto groups = TRY(grouped(tx, rows, curriculum_id));
  std::vector<CurriculumPerson> people;
  for (const VersionSteps& group : groups)
    for (const store::CurriculumAssignment& row : group.steps)
      TRY(add_assignment_to(tx, people, group, row, account_id));
  for (CurriculumPerson& person : people) {
    std::vector<std::vector<assessment::StepTrial>> trials;
    for (const StepRecord& step : person.steps) trials.push_back(step.trials);
    person.progress = assessment::progress(person.curriculum, trials);
  }
  std::ranges::stable_sort(people, {}, &CurriculumPerson::name);
  return people;
}

Result<bool> may_be_handed_out(store::Reading& tx, const std::string& account_id,
                               const std::string& study_id) {
  const auto rows = TRY(store::curriculum_assignments(tx, account_id));
  const auto row = std::ranges::find(rows, study_id, &store::CurriculumAssignment::study_id);
  if (row == rows.end()) return true;
  const auto people = TRY(people_in_curricula(tx, account_id, row->curriculum_id));
  for (const CurriculumPerson& person : people) {
    if (person.version != row->version) continue;
    for (std::size_t s = 0; s < person.curriculum.steps.size(); ++s)
      if (person.curriculum.steps[s].id == row->step_id)
        return person.progress.steps[s].open && !person.progress.steps[s].verdict.passed();
  }
  return true;
}

}  // namespace api
}  // namespace tractus
