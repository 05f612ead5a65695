#include "lab/identify/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/identify/fit_report.hpp"
#include "lab/identify/law_dependence.hpp"
#include "lab/identify/residual_dependence.hpp"
#include "lab/identify/selection.hpp"
#include "lab/identify/sensitivity.hpp"
#include "lab/identify/structure_posterior.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr const auto& kAnswer = kSettings.diagnosis;

/// Numbers of an effect as a model file has them.
FoundEffect found(const Problem& problem, const Fit& fit, const std::string& id) {
  FoundEffect out;
  out.id = id;
  for (const Candidate& candidate : problem.candidates()) {
    if (candidate.facts.id != id) continue;
    const double inflation = std::max(1.0, fit.whitened_rms);
    for (const auto& [what, value, sd] : problem.derived(fit.structure, fit.values, id))
      out.parameters.push_back({what, {value}, {inflation * sd}});
    if (candidate.facts.free_per_trial) break;
    for (const effects::Param& p : candidate.facts.params) {
      FoundParameter parameter{p.name, {}, {}};
      for (const Estimate& e : fit.estimates)
        if (e.pointer == id + "/" + p.name || e.pointer.starts_with(id + "/" + p.name + "/")) {
          parameter.value.push_back(e.value);
          parameter.sd.push_back(e.sd);
        }
      out.parameters.push_back(std::move(parameter));
    }
  }
  return out;
}

/// The base and then the effects in the order in which they brought most.
std::vector<Step> steps(const Residual& residual, Selection& selection, const Diagnosis& so_far) {
  std::vector<Step> out{
      {"base", so_far.base_fit.rmse, so_far.base_fit.held_out_rmse, so_far.base_fit.noise_floor}};
  Structure sum;
  for (const std::string& id : selection.order()) {
    sum = plus(sum, id);
    const bool last = sum == so_far.final_fit.structure;
    const Fit fit =
        last ? so_far.final_fit : report(residual, selection.tried().at(name(sum)), true);
    out.push_back({"+ " + id, fit.rmse, fit.held_out_rmse, fit.noise_floor});
  }
  return out;
}

std::string note_on(const ParameterSpace& space, const Candidate& candidate,
                    const Selection& selection) {
  if (!candidate.possible) return candidate.why_not;
  const auto seen = selection.screens().find(candidate.facts.id);
  if (seen == selection.screens().end()) return "not tried";
  if (!seen->second.excited)
    return seen->second.independent_share > 0.0
               ? "not excited: whatever it would do, the model's own numbers do as well; record " +
                     experiment_for(space, candidate.facts.id, "")
               : "not excited: these recordings never call on it; record " +
                     experiment_for(space, candidate.facts.id, "");
  return "";
}

std::vector<Ranked> ranking(const Residual& residual, Selection& selection,
                            const StructurePosterior& posterior) {
  const Problem& problem = residual.problem();
  std::vector<Ranked> out;
  for (const Candidate& candidate : problem.candidates()) {
    Ranked ranked{candidate.facts.id,
                  posterior.of_effect(candidate.facts.id),
                  {},
                  note_on(problem, candidate, selection)};
    const auto single = selection.tried().find(candidate.facts.id);
    if (single != selection.tried().end())
      ranked.held_out_rmse = held_out_rmse(residual, single->second);
    out.push_back(std::move(ranked));
  }
  std::ranges::stable_sort(out, [](const Ranked& a, const Ranked& b) {
    if (a.probability != b.probability) return a.probability > b.probability;
    return a.held_out_rmse.value_or(1e300) < b.held_out_rmse.value_or(1e300);
  });
  return out;
}

/// How small each effect that is not named would have been seen.
void add_detection_limits(const Residual& residual, const Selection& selection,
                          const Solution& final, double rmse, std::vector<Ranked>& ranking) {
  const bool is_base = final.structure.effects.empty();
  for (Ranked& ranked : ranking) {
    const auto on_base = selection.screens().find(ranked.id);
    if (on_base == selection.screens().end() || contains(final.structure, ranked.id)) continue;
    ranked.detection_limits = detection_limits(
        residual, final, rmse,
        is_base ? on_base->second : linear_screen(residual, final, ranked.id), ranked.id);
  }
}

/// Share of the mean square that is left which recorded signals predict; none if they do so in too few trials.
double predicted_share(const ResidualDependence& rest) {
  return rest.trials_better >= kAnswer.most_trials ? rest.predictable : 0.0;
}

/// Probability that a material effect is missing from a model, by the error over the floor and by what signals and laws
/// predict of it: a logistic model that was fitted to labelled answers, tests/hidden_physics/benchmark/calibrate.py.
double probability_of_more(const Problem& problem, const ResidualDependence& rest,
                           const LawDependence& laws, const Fit& fit) {
  const MoreMissingOdds& odds = problem.selection_thresholds().more;
  const double above = std::log(std::max(1.0, fit.held_out_rmse / fit.noise_floor));
  return 1.0 /
         (1.0 + std::exp(-odds.at_floor - odds.per_log_error * above -
                         odds.per_share * predicted_share(rest) - odds.per_law_share * laws.share));
}

/// What the rest varies with: laws, or signals where these predict more.
std::string words_of(const ResidualDependence& rest, const LawDependence& laws) {
  if (laws.share <= predicted_share(rest)) return rest.words;
  return fmt::format("{} ({:.0f} %)", fmt::join(laws.laws, ", "), 100.0 * laws.share);
}

/// How much of the force is noise, or an error of the motion.
double floor_share(const Problem& problem, const Fit& fit) {
  const double measured = problem.channels().front().measured_rms;
  return measured > 0.0 ? fit.noise_floor / measured : 0.0;
}

/// Do the effects take away most of what there was to take?
bool explain_most(const ResidualDependence& rest, const Fit& base, const Fit& fit) {
  const auto square = [](double v) { return v * v; };
  const double after = square(fit.held_out_rmse),
               least = std::min((1.0 - rest.predictable) * after, square(fit.noise_floor));
  return after - least < kAnswer.most_left * (square(base.held_out_rmse) - least);
}

/// Probability that the answer is right as a whole: the effects that it names, and whether more is missing.
double stated_probability(const Diagnosis& d, double more, double posterior) {
  if (d.effects.size() >= kAnswer.imitating_effects) more = std::max(more, kAnswer.imitation);
  more = std::clamp(more, kSettings.posterior.unforeseen, 1.0 - kSettings.posterior.unforeseen);
  switch (d.verdict) {
    case Verdict::undecided:
      return std::numeric_limits<double>::quiet_NaN();
    case Verdict::unexplained:
      return more;
    case Verdict::partly:
      return posterior * more;
    default:
      return posterior * (1.0 - more);
  }
}

}  // namespace

Result<Diagnosis> diagnose(const Problem& problem, const DiagnoseOptions& options,
                           const core::Progress& progress) {
  for (const std::string& id : options.only)
    if (std::ranges::none_of(problem.candidates(), [&](const auto& c) { return c.facts.id == id; }))
      return Error{Errc::bad_input, fmt::format("effect '{}' is not in the catalogue of the {} rig",
                                                id, problem.rig())};
  const Residual residual(problem, options.threads);
  if (residual.size() == 0)
    return Error{Errc::bad_input, "the recordings are too short to compare"};
  Selection selection(residual, options, progress);
  const auto early = [&] {
    if (options.early)
      options.early(ranking(residual, selection,
                            StructurePosterior(residual, selection, selection.leading())));
  };
  if (!selection.run(early)) return Error{Errc::cancelled, "stopped"};
  Diagnosis out;
  out.notes = problem.notes();
  out.base_fit = report(residual, selection.tried().at(""), true);
  out.base = {out.base_fit.rmse, out.base_fit.held_out_rmse, out.base_fit.noise_floor};
  Solution& chosen = selection.chosen();
  ResidualDependence rest = residual_dependence(residual, chosen);
  LawDependence laws = law_dependence(residual, chosen);
  out.final_fit = chosen.structure.effects.empty() ? out.base_fit : report(residual, chosen, true);
  out.base.noise_floor = std::min(out.base.noise_floor, out.final_fit.noise_floor);
  const bool more = probability_of_more(problem, rest, laws, out.final_fit) > 0.5;
  const bool named = !chosen.structure.effects.empty() &&
                     (!more || explain_most(rest, out.base_fit, out.final_fit));
  out.floor_share = floor_share(problem, out.final_fit);
  const bool imitating = named && chosen.structure.effects.size() >= kAnswer.imitating_effects;
  out.verdict = named  ? more || imitating ? Verdict::partly : Verdict::missing
                : more ? Verdict::unexplained
                : out.floor_share > kAnswer.undecided_share ? Verdict::undecided
                                                            : Verdict::complete;
  if (!named && !chosen.structure.effects.empty()) {
    out.final_fit = out.base_fit;
    rest = residual_dependence(residual, selection.base());
    laws = law_dependence(residual, selection.base());
  }
  const Solution& final = named ? chosen : selection.base();
  const StructurePosterior posterior(residual, selection, final);
  if (imitating && !more)
    out.notes.push_back(fmt::format(
        "{} effects together bring the residual to the floor; so many at once more likely imitate "
        "one that is in no catalogue",
        chosen.structure.effects.size()));
  for (const std::string& id : named ? selection.order() : std::vector<std::string>{}) {
    out.effects.push_back(found(problem, out.final_fit, id));
    out.effects.back().probability = posterior.of_effect(id);
  }
  out.probability = stated_probability(out, probability_of_more(problem, rest, laws, out.final_fit),
                                       posterior.of_structure(final.structure));
  out.steps = named ? steps(residual, selection, out)
                    : std::vector<Step>{{"base", out.base.rmse, out.base.held_out_rmse,
                                         out.base_fit.noise_floor}};
  if (more) out.depends_on = words_of(rest, laws);
  out.dependence_explained = predicted_share(rest);
  out.law_explained = laws.share;
  if (!selection.refused().empty())
    out.notes.push_back(
        fmt::format("{} was left out: what it would take out of the residual follows the motion, "
                    "so it is no trend of "
                    "the sensor's own",
                    selection.refused()));
  for (const std::string& id : selection.unseen_in_air())
    out.notes.push_back(
        fmt::format("{} was left out: it lowers the error in contact, where noise of the pose "
                    "does as much, and is not seen in free air, where it would be felt as well",
                    id));
  out.ranking = ranking(residual, selection, posterior);
  if (options.detection_limits)
    add_detection_limits(residual, selection, final, out.final_fit.rmse, out.ranking);
  out.confounded = posterior.confounded();
  out.hypotheses = posterior.hypotheses(selection);
  out.discriminating_experiment = posterior.discriminating_experiment(problem);
  if (std::size_t(problem.trials()) < kAnswer.few_trials)
    out.notes.push_back(
        fmt::format("{} trial{} only: stretches of time were held out instead of trials, and the "
                    "probabilities are worth less; record {} more",
                    problem.trials(), problem.trials() == 1 ? "" : "s",
                    kAnswer.few_trials - std::size_t(problem.trials())));
  return out;
}

}  // namespace lab
}  // namespace tractus
