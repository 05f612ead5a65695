#include "lab/identify/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "lab/identify/fit_report.hpp"
#include "lab/identify/residual_dependence.hpp"
#include "lab/identify/selection.hpp"
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
  std::vector<Step> out{{"base", so_far.base_fit.rmse, so_far.base_fit.held_out_rmse}};
  Structure sum;
  for (const std::string& id : selection.order()) {
    sum = plus(sum, id);
    const bool last = sum == so_far.final_fit.structure;
    const Fit fit =
        last ? so_far.final_fit : report(residual, selection.tried().at(name(sum)), true);
    out.push_back({"+ " + id, fit.rmse, fit.held_out_rmse});
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

Verdict verdict(const Problem& problem, const Selection& selection) {
  const Solution &base = selection.base(), &chosen = selection.chosen();
  const double before = base.mean_square(), after = chosen.mean_square();
  if (chosen.structure.effects.empty())
    return at_floor(problem, before, before) || selection.immaterial() ? Verdict::complete
                                                                       : Verdict::unexplained;
  if (at_floor(problem, after, before)) return Verdict::missing;
  return explains(after, before) ? Verdict::partly : Verdict::unexplained;
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
  out.verdict = verdict(problem, selection);
  const bool named = out.verdict == Verdict::missing || out.verdict == Verdict::partly;
  Solution& final = named ? selection.chosen() : selection.tried().at("");
  out.final_fit = report(residual, final, true);
  const StructurePosterior posterior(residual, selection, final);
  if (out.verdict == Verdict::missing && posterior.outside() > 0.5) {
    out.verdict = Verdict::partly;
    out.notes.push_back(fmt::format(
        "{} effects together bring the residual to the floor; so many at once more likely imitate "
        "one that is in no catalogue",
        final.structure.effects.size()));
  }
  out.probability = out.verdict == Verdict::unexplained ? posterior.outside()
                    : out.verdict == Verdict::partly    ? kAnswer.more_is_missing
                                                        : posterior.of_structure(final.structure);
  for (const std::string& id : named ? selection.order() : std::vector<std::string>{}) {
    out.effects.push_back(found(problem, out.final_fit, id));
    out.effects.back().probability = posterior.of_effect(id);
  }
  out.steps = named ? steps(residual, selection, out)
                    : std::vector<Step>{{"base", out.base.rmse, out.base.held_out_rmse}};
  if (out.verdict == Verdict::partly || out.verdict == Verdict::unexplained) {
    const ResidualDependence rest = residual_dependence(residual, final);
    out.depends_on = rest.words;
    out.dependence_explained = rest.explained;
  }
  if (!selection.refused().empty())
    out.notes.push_back(
        fmt::format("{} would bring the residual to the floor, but what it takes out follows the "
                    "motion before: "
                    "something with a slow memory is missing that is in no catalogue",
                    selection.refused()));
  out.ranking = ranking(residual, selection, posterior);
  out.confounded = posterior.confounded();
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
