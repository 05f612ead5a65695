#include "lab/io/torque.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/report/answer.hpp"

namespace tractus {
namespace lab_io {
namespace {

using core::Json;
using lab::Verdict;

/// Less is no turn.
constexpr double kLeastTurn_rad = 1e-3;

bool changes_by(const std::vector<double>& values, double least) {
  if (values.empty()) return false;
  const auto [low, high] = std::ranges::minmax(values);
  return high - low > least;
}

bool more(Verdict verdict) { return verdict == Verdict::partly || verdict == Verdict::unexplained; }

/// The verdict on force and torque together.
lab::Diagnosis joined(const lab::Diagnosis& force, const lab::Diagnosis& torque) {
  lab::Diagnosis out = force;
  out.effects.insert(out.effects.end(), torque.effects.begin(), torque.effects.end());
  const bool left = more(force.verdict) || more(torque.verdict);
  const bool undecided =
      force.verdict == Verdict::undecided || torque.verdict == Verdict::undecided;
  out.verdict = !out.effects.empty() ? left ? Verdict::partly : Verdict::missing
                : left               ? Verdict::unexplained
                : undecided          ? Verdict::undecided
                                     : Verdict::complete;
  out.probability = force.probability * torque.probability;  // that all of it is right
  return out;
}

}  // namespace

bool records_torque(const trial::ProbingSet& set) {
  return !set.trials.empty() && std::ranges::all_of(set.trials, [](const auto& trial) {
    return !trial.x_m.empty() && changes_by(trial.theta_rad, kLeastTurn_rad) &&
           changes_by(trial.tz_Nm, 0.0);
  });
}

models::ProbingModel about_axis(models::ProbingModel model) {
  std::erase_if(model.effects, [](const effects::EffectInstance& use) {
    const auto facts = effects::probing_facts(use);
    return !facts || facts->channel != effects::Channel::torque;
  });
  return model;
}

core::Result<void> add_torque(const lab::Problem& torque, const lab::Diagnosis& force,
                              const DiagnoseRequest& wish, LabResult& out,
                              const core::Progress& progress) {
  lab::DiagnoseOptions options = wish.options;
  options.early = {};
  std::erase_if(options.only, [&](const std::string& id) {
    return std::ranges::none_of(torque.candidates(),
                                [&](const lab::Candidate& c) { return c.facts.id == id; });
  });
  if (options.only.empty() && !wish.options.only.empty()) return {};
  const auto found = TRY(lab::diagnose(torque, options, progress));
  const std::string& primary = torque.channels().front().name;
  const auto [headline, detail] = lab::sentences(found, lab::name_and_unit(primary).unit);
  const Json all = lab::to_json(found);
  Json own{{"primary", primary}, {"headline", headline}, {"detail", detail}};
  for (const char* key : {"verdict", "probability", "base", "effects", "ranking", "steps",
                          "hypotheses", "rest_explained"})
    own[key] = all[key];
  const lab::Diagnosis both = joined(force, found);
  const Json of_both = lab::to_json(both);
  for (const char* key : {"verdict", "probability", "effects"}) out.json[key] = of_both[key];
  lab::StatedVerdict& stated = *out.content.stated;
  stated.verdict = both.verdict, stated.probability = both.probability;
  if (!found.effects.empty() || more(found.verdict))
    stated.headline = lab::sentences(both, "").headline;
  stated.detail += " About the probe's axis: " + headline + " " + detail;
  const Json turned = torque.model(found.final_fit.structure, found.final_fit.values);
  (*out.model)["base"]["rotary"] = turned["base"]["rotary"];
  for (const Json& effect : turned["effects"])
    if (std::ranges::any_of(found.effects, [&](const auto& one) { return effect["id"] == one.id; }))
      (*out.model)["effects"].push_back(effect);
  out.json["torque"] = std::move(own);
  return {};
}

}  // namespace lab_io
}  // namespace tractus
