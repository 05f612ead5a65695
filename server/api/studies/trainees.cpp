#include "server/api/studies/trainees.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/trials/ratings.hpp"
#include "metrics/metric.hpp"
#include "server/api/trials/trial_json.hpp"
#include "statistics/distributions/proportions.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;
using Trials = std::vector<store::CohortTrial>;

constexpr std::int64_t kMaxTrials = 20'000;
constexpr double kRelapseThreshold = 1.25;
/// Edges of stated confidence: "about half sure" to "certain".
constexpr std::array kConfidence{0.0, 0.55, 0.65, 0.75, 0.85, 0.95, 1.0};

bool counts(const store::CohortTrial& trial) {
  return trial.complete && trial.summary.state == store::AssessmentState::assessed &&
         trial.summary.correct &&
         (trial.study.empty() || trial.place == store::StudyTrialState::counts);
}

/// Who may ask for a trainee's page may know the trainee: an assignment's trials go by the
/// account's name, a study's by its pseudonym.
const std::string& name_of(const store::CohortTrial& trial) {
  if (!trial.person.empty()) return trial.person;
  return trial.study.empty() ? trial.summary.operator_name : trial.participant;
}

Result<Trials> trials_for(const Call& call) {
  const std::string study = call.has("study") ? call.text("study") : "";
  return call.backend.store.read([&](store::Reading& tx) -> Result<Trials> {
    if (!study.empty()) {
      const auto known = TRY(store::series_exists(tx, study));
      if (!known)
        return core::Error{core::Errc::bad_input,
                           "study: there is no study " + study.substr(0, 32)};
    }
    store::TrialFilter whose;
    if (call.of == Scope::cohort) whose.taught_by = call.caller.id;
    if (call.of == Scope::own) whose.seen_by = call.caller.id;
    return store::trials_for_teaching(tx, study, whose, kMaxTrials);
  });
}

std::size_t place_of(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::ranges::find(names, name);
  if (at != names.end()) return std::size_t(at - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

/// [score][scenario]: means over all attempts.
std::vector<std::vector<double>> means_of(const assessment::Cohort& cohort) {
  std::vector<std::vector<double>> sums(cohort.scores.size(),
                                        std::vector<double>(cohort.scenarios.size(), 0.0));
  auto numbers = sums;
  for (const auto& attempts : cohort.attempts)
    for (const auto& one : attempts)
      for (std::size_t k = 0; k < sums.size(); ++k)
        if (std::isfinite(one.scores[k])) {
          sums[k][one.scenario] += one.scores[k];
          numbers[k][one.scenario] += 1.0;
        }
  for (std::size_t k = 0; k < sums.size(); ++k)
    for (std::size_t s = 0; s < sums[k].size(); ++s)
      sums[k][s] = numbers[k][s] > 0.0 ? sums[k][s] / numbers[k][s] : std::nan("");
  return sums;
}

/// The metrics that a trainee's page follows beside right and wrong, as far as a trial has them.
std::vector<std::string> followed_metrics(const Trials& trials) {
  auto known = metrics::all();
  std::erase_if(known, [&](const metrics::MetricInfo& info) {
    return info.followed == 0 || std::ranges::none_of(trials, [&](const auto& trial) {
             return trial.metrics.contains(info.id);
           });
  });
  std::ranges::sort(known, {}, &metrics::MetricInfo::followed);
  std::vector<std::string> out;
  for (const metrics::MetricInfo& info : known) out.push_back(info.id);
  return out;
}

/// What passing is for one trainee, or for those who begin now.
struct TraineeRule {
  const assessment::Criteria& criteria;
  std::size_t version;  ///< from 1; 0: the usual one
  const assessment::Certification& certification;
  assessment::TraineeRules rules;
};

TraineeRule rule_for(const Programme& of, std::optional<std::int64_t> began_utc_us) {
  const auto& criteria = of.criteria.for_start(began_utc_us);
  statistics::Rates rates;
  for (const auto& one : criteria.requirements)
    if (one.kind == assessment::RequirementKind::lc_cusum) rates = one.rates;
  return {criteria,
          of.criteria.number_for(began_utc_us),
          assessment::usual_certification(rates),
          {rates, std::nullopt, kRelapseThreshold}};
}

TraineeRule rule_of(const Programme& of, std::size_t trainee) {
  return rule_for(of, of.trials[trainee].front().summary.started_utc_us);
}

Json rule_json(const TraineeRule& of) {
  Json requirements = Json::array();
  for (const auto& one : of.criteria.requirements) requirements.push_back(assessment::text_of(one));
  return {{"adequate", of.rules.rates.adequate},
          {"inadequate", of.rules.rates.inadequate},
          {"trials", of.certification.trials},
          {"threshold", of.rules.threshold.value_or(of.certification.threshold)},
          {"relapse", of.rules.relapse},
          {"version", of.version},
          {"requirements", requirements}};
}

/// What keeps somebody from being certified; what carries it for one who is.
std::string reasons_in(const assessment::Verdict& of) {
  std::string out;
  for (const auto& one : of.now) {
    if (!of.holds_now() && one.met) continue;
    if (!out.empty()) out += "; ";
    out += of.now.size() == 1 ? one.found : one.required + ": " + one.found;
  }
  return out;
}

assessment::Verdict verdict_of(const Programme& of, std::size_t trainee, const TraineeRule& rule) {
  std::vector<assessment::JudgedTrial> trials;
  for (const auto& trial : of.trials[trainee]) trials.push_back(judged_trial(trial));
  return assessment::judge(rule.criteria, trials);
}

Json next_json(const Programme& of, const Json& report) {
  const auto at = of.next.find(report["trainee"].get<std::string>());
  if (at == of.next.end()) return report["next"];
  return {{"scenario", at->second.case_title}, {"why", at->second.why}};
}

Json short_json(const Programme& of, std::size_t trainee, const TraineeRule& rule,
                const Json& report) {
  Json out = Json::object();
  for (const char* key :
       {"trainee", "trials", "right", "share", "wilson_low", "wilson_high", "state"})
    out[key] = report[key];
  const auto verdict = verdict_of(of, trainee, rule);
  out["certified"] = verdict.holds_now();
  out["why"] = reasons_in(verdict);
  out["next"] = next_json(of, report);
  out["simulated"] =
      std::ranges::any_of(of.trials[trainee], [](const auto& t) { return t.summary.simulated; });
  out["last_utc_us"] = of.trials[trainee].back().summary.started_utc_us;
  return out;
}

std::optional<double> confidence_of(Backend& backend, const std::string& trial_id) {
  const auto trial =
      backend.store.read([&](store::Reading& tx) { return store::trial_of(tx, trial_id); });
  if (!trial || !*trial) return std::nullopt;
  const auto events = core::parse_json((*trial)->events, "events", core::kStoredJson);
  if (!events) return std::nullopt;
  const Json answer = answer_json(*events);
  if (!answer.is_object() || !answer["confidence"].is_number()) return std::nullopt;
  return answer["confidence"].get<double>();
}

Json attempts_json(const Programme& of, std::size_t trainee, const assessment::Standing& standing,
                   const std::vector<std::optional<double>>& confidence) {
  Json out = Json::array();
  for (std::size_t t = 0; t < of.trials[trainee].size(); ++t) {
    const auto& summary = of.trials[trainee][t].summary;
    const auto& attempt = of.cohort.attempts[trainee][t];
    Json scores = Json::object();
    for (std::size_t k = 0; k < of.cohort.scores.size(); ++k)
      scores[of.cohort.scores[k]] =
          std::isfinite(attempt.scores[k]) ? Json(attempt.scores[k]) : Json();
    const bool watched = standing.signalled_at > 0 && t >= standing.signalled_at;
    const bool linked = !of.unlinked.contains(summary.id);
    out.push_back(
        {{"number", t + 1},
         {"trial", linked ? Json(summary.id) : Json()},
         {"scenario", summary.case_title},
         {"started_utc_us", linked ? Json(summary.started_utc_us) : Json()},
         {"correct", attempt.right},
         {"confidence", confidence[t] ? Json(*confidence[t]) : Json()},
         {"sum", standing.sums[t]},
         {"relapse_sum", watched && t - standing.signalled_at < standing.relapse_sums.size()
                             ? Json(standing.relapse_sums[t - standing.signalled_at])
                             : Json()},
         {"scores", scores}});
  }
  return out;
}

Json calibration_json(const std::vector<assessment::Attempt>& attempts,
                      const std::vector<std::optional<double>>& confidence) {
  Json out = Json::array();
  for (std::size_t bin = 0; bin + 1 < kConfidence.size(); ++bin) {
    const bool last = bin + 2 == kConfidence.size();
    double trials = 0.0, right = 0.0, stated = 0.0;
    for (std::size_t t = 0; t < attempts.size(); ++t) {
      if (!confidence[t] || *confidence[t] < kConfidence[bin]) continue;
      if (last ? *confidence[t] > 1.0 : *confidence[t] >= kConfidence[bin + 1]) continue;
      trials += 1.0, right += attempts[t].right ? 1.0 : 0.0, stated += *confidence[t];
    }
    if (trials == 0.0) continue;
    const auto share = statistics::wilson({right, trials});
    out.push_back({{"low", kConfidence[bin]},
                   {"high", kConfidence[bin + 1]},
                   {"stated", stated / trials},
                   {"trials", long(trials)},
                   {"right", long(right)},
                   {"wilson_low", share.low},
                   {"wilson_high", share.high}});
  }
  return out;
}

/// What the curricula want next of those who are in one; for a trainee, of the caller alone.
Result<std::map<std::string, CurriculumNext>> curriculum_next(store::Reading& tx,
                                                              const Call& call) {
  std::map<std::string, CurriculumNext> out;
  const auto people = TRY(people_in_curricula(tx, call.of == Scope::own ? call.caller.id : "", ""));
  for (const CurriculumPerson& person : people) {
    if (!person.progress.next_step) continue;
    const auto of = TRY(store::case_of(tx, person.progress.next_case));
    const auto& step = person.curriculum.steps[*person.progress.next_step];
    out[person.name] = {of ? of->title : person.progress.next_case,
                        "the step '" + step.name + "' of the curriculum '" + person.title +
                            "' is open; of its cases this one may fail most"};
  }
  return out;
}

}  // namespace

Result<Programme> programme_of(const Call& call) {
  auto trials = TRY(trials_for(call));
  std::erase_if(trials, [](const auto& trial) { return !counts(trial); });
  Programme out{.cohort = {},
                .trials = {},
                .criteria = {},
                .next = {},
                .unlinked = {},
                .backend = &call.backend};
  TRY(call.backend.store.read([&](store::Reading& tx) -> Result<void> {
    out.criteria = TRY(criteria_history(tx, store::CriteriaKind::programme, ""));
    out.next = TRY(curriculum_next(tx, call));
    if (call.of != Scope::own) out.unlinked = TRY(store::trials_with_hidden_name(tx));
    return {};
  }));
  out.cohort.scores = followed_metrics(trials);
  for (store::CohortTrial& trial : trials) {
    const std::string& who = name_of(trial);
    const std::size_t at = place_of(out.cohort.trainees, who);
    out.cohort.attempts.resize(out.cohort.trainees.size());
    out.trials.resize(out.cohort.trainees.size());
    assessment::Attempt attempt;
    attempt.order = double(out.trials[at].size() + 1);
    attempt.right = *trial.summary.correct;
    attempt.scenario = place_of(out.cohort.scenarios, trial.summary.case_title);
    for (const std::string& id : out.cohort.scores) {
      const auto found = trial.metrics.find(id);
      attempt.scores.push_back(found == trial.metrics.end() ? std::nan("") : found->second);
    }
    out.cohort.attempts[at].push_back(std::move(attempt));
    out.trials[at].push_back(std::move(trial));
  }
  out.cohort.means = means_of(out.cohort);
  return out;
}

Json list_json(const Programme& of) {
  std::vector<std::size_t> order(of.cohort.trainees.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return of.cohort.trainees[i]; });
  Json list = Json::array();
  for (const std::size_t i : order) {
    const TraineeRule rule = rule_of(of, i);
    const auto report = assessment::trainee_report(of.cohort, i, rule.certification, rule.rules);
    list.push_back(short_json(of, i, rule, report.report));
  }
  return {{"rule", rule_json(rule_for(of, {}))}, {"trainees", list}};
}

Json trainee_json(const Programme& of, std::size_t trainee) {
  const auto& attempts = of.cohort.attempts[trainee];
  const TraineeRule whole = rule_of(of, trainee);
  const Json report =
      assessment::trainee_report(of.cohort, trainee, whole.certification, whole.rules).report;
  const Json rule = rule_json(whole);
  const auto standing = assessment::standing(
      attempts, whole.rules.rates, report["threshold"].get<double>(), whole.rules.relapse);
  std::vector<std::optional<double>> confidence;
  for (const auto& trial : of.trials[trainee])
    confidence.push_back(confidence_of(*of.backend, trial.summary.id));
  Json out = short_json(of, trainee, whole, report);
  for (const char* key : {"competent_at_trial", "relapses", "scenarios", "scores"})
    out[key] = report[key];
  out["rule"] = rule;
  out["attempts"] = attempts_json(of, trainee, standing, confidence);
  out["calibration"] = calibration_json(attempts, confidence);
  return out;
}

}  // namespace api
}  // namespace tractus
