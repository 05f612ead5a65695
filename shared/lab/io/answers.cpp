#include "lab/io/answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/try.hpp"
#include "effects/catalogues.hpp"
#include "lab/identify/user_effect_checks.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/io/torque.hpp"
#include "lab/report/answer.hpp"

namespace tractus {
namespace lab_io {
namespace {

using core::Errc;
using core::Error;
using core::Result;

lab::Side side(lab::Samples samples) {
  lab::Side out{std::move(samples), {}};
  out.comparison = lab::compare(out.samples);
  return out;
}

LabResult begun(const Case& opened) {
  LabResult out;
  out.content.model_name = opened.model_name;
  out.content.set_name = opened.set_name;
  out.content.simulated = opened.simulated;
  out.content.catalogue = opened.problem->candidates();
  out.content.notes = opened.problem->notes();
  return out;
}

void compare_given(const Case& opened, LabResult& answer) {
  answer.content.before = side(lab::samples_as_given(*opened.problem, opened.recorded));
  answer.content.given_rmse = answer.content.before.comparison.rmse;
  answer.content.map = lab::tract_map(answer.content.before.samples);
}

void compare_better(const Case& opened, const lab::Fit& fit, LabResult& answer) {
  answer.content.better =
      side(lab::samples_of(*opened.problem, fit.structure, fit.values, opened.recorded));
  answer.content.start = opened.problem->parameters(fit.structure);
}

/// What is then held against the better model: its own numbers fitted, and still wrong.
void compare_refitted(const Case& opened, const lab::Fit& fit, LabResult& answer) {
  answer.content.before =
      side(lab::samples_of(*opened.problem, fit.structure, fit.values, opened.recorded));
  answer.content.before_name = "refitted";
  answer.content.map = lab::tract_map(answer.content.before.samples);
}

/// Numbers of the given model that a fit pushed to the edge of their range: it is far from these
/// recordings, and what is named beside them is worth little.
std::string at_their_edge(const lab::Fit& fit) {
  std::vector<std::string> names;
  for (const lab::Estimate& e : fit.estimates)
    if (e.at_bound && e.pointer.starts_with('/')) names.push_back(e.pointer);
  if (names.empty()) return {};
  return fmt::format(
      "{} ended at the edge of {}: the model as given is far from these recordings, and what is "
      "said of effects is worth little; begin with numbers that are nearer",
      fmt::join(names, ", "), names.size() == 1 ? "its range" : "their ranges");
}

/// What these recordings cannot tell of, whatever the verdict: effects that their motion never
/// calls on.
std::string not_excited(const lab::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const lab::Ranked& ranked : diagnosis.ranking)
    if (ranked.note.starts_with("not excited")) names.push_back(effects::label_of(ranked.id));
  if (names.empty()) return {};
  return fmt::format(
      "these recordings cannot tell whether there is {}: their motion does not call "
      "on {}",
      fmt::join(names, ", "), names.size() == 1 ? "it" : "them");
}

std::string why_no_candidate(std::string_view rig, const std::string& id) {
  const auto* facts = effects::find_facts(rig, id);
  if (facts && facts->channel == effects::Channel::torque)
    return fmt::format("'{}' acts about the axis and shows in sets that only turn", id);
  return fmt::format(
      "'{}': no such effect on the {} rig, or the model has it already; see tractus effects", id,
      rig);
}

/// An id that this recording can show, or why not.
Result<void> known(const lab::Problem& problem, const std::string& id) {
  const auto& all = problem.candidates();
  const auto it =
      std::ranges::find_if(all, [&](const lab::Candidate& c) { return c.facts.id == id; });
  if (it == all.end()) return Error{Errc::not_found, why_no_candidate(problem.rig(), id)};
  if (!it->possible)
    return Error{Errc::bad_input, fmt::format("'{}' cannot be fitted: {}", id, it->why_not)};
  return {};
}

/// Of two structures the effects in which they differ, "nothing" of none.
std::vector<std::string> differing(const lab::Structure& one, const lab::Structure& other) {
  const auto own = [](const lab::Structure& of, const lab::Structure& against) -> std::string {
    for (const std::string& id : of.effects)
      if (std::ranges::find(against.effects, id) == against.effects.end()) return id;
    return "nothing";
  };
  return {own(one, other), own(other, one)};
}

/// Recordings that would decide, best first; the best one takes the place of the recommendation in words.
Result<std::vector<lab::ProgramValue>> programs_for(const Case& opened, const DiagnoseRequest& wish,
                                                    lab::Diagnosis& diagnosis,
                                                    const core::Progress& progress) {
  using Weigh = DiagnoseRequest::Weigh;
  auto& experiment = diagnosis.discriminating_experiment;
  std::vector<lab::ProgramValue> out;
  if (!opened.kept || wish.programs == Weigh::never ||
      (wish.programs == Weigh::if_undecided && !experiment))
    return out;
  out = TRY(lab::weigh_programs(*opened.problem, diagnosis, opened.kept->model, opened.kept->set,
                                {.threads = wish.options.threads}, progress));
  std::erase_if(out, [](const lab::ProgramValue& value) { return !(value.expected_gain > 0.0); });
  if (out.empty()) return out;
  if (!experiment)
    experiment.emplace(
        differing(diagnosis.hypotheses[0].structure, diagnosis.hypotheses[1].structure));
  experiment->recording = out.front().program.words;
  experiment->expected_gain = out.front().expected_gain;
  return out;
}

core::Json to_json(const std::vector<lab::ProgramValue>& programs) {
  core::Json out = core::Json::array();
  for (const lab::ProgramValue& value : programs)
    out.push_back({{"name", value.program.name},
                   {"recording", value.program.words},
                   {"duration_s", value.seconds},
                   {"expected_gain", lab::number(value.expected_gain)},
                   {"program", value.program.to_json()}});
  return out;
}

}  // namespace

LabResult compared(const Case& opened) {
  LabResult out = begun(opened);
  compare_given(opened, out);
  out.json = lab::to_json(out.content.before.comparison);
  out.json["model"] = opened.model_name;
  out.json["notes"] = opened.problem->notes();
  return out;
}

Result<LabResult> diagnosed(const Case& opened, const DiagnoseRequest& wish,
                            const core::Progress& progress) {
  const bool more =
      wish.report || wish.propose > 0 || wish.programs != DiagnoseRequest::Weigh::never;
  auto diagnosis =
      TRY(lab::diagnose(*opened.problem, wish.options, part_of(progress, 0.0, more ? 0.6 : 1.0)));
  LabResult out = begun(opened);
  if (wish.propose > 0)
    out.discovery = TRY(lab::discover(*opened.problem, diagnosis,
                                      {.threads = wish.options.threads, .most = wish.propose},
                                      part_of(progress, 0.6, 0.3)));
  out.programs = TRY(programs_for(opened, wish, diagnosis, part_of(progress, 0.6, 0.4)));
  if (auto edge = at_their_edge(diagnosis.final_fit); !edge.empty())
    diagnosis.notes.insert(diagnosis.notes.begin(), std::move(edge));
  if (auto blind = not_excited(diagnosis); !blind.empty())
    diagnosis.notes.push_back(std::move(blind));
  if (!opened.own.empty())
    for (std::string& remark : lab::likenesses(*opened.problem, opened.own,
                                               diagnosis.base_fit.values, wish.options.threads))
      diagnosis.notes.push_back(std::move(remark));
  out.json = lab::to_json(diagnosis);
  const std::string& primary = opened.problem->channels().front().name;
  const auto [headline, detail] = lab::sentences(diagnosis, lab::name_and_unit(primary).unit);
  out.content.stated = {diagnosis.verdict, diagnosis.probability, headline, detail};
  if (!out.programs.empty()) out.json["settle"]["programs"] = to_json(out.programs);
  out.json["primary"] = primary;
  if (out.discovery) out.json["discovery"] = lab::to_json(*out.discovery);
  out.model = opened.problem->model(diagnosis.final_fit.structure, diagnosis.final_fit.values);
  if (opened.torque) TRY(add_torque(*opened.torque, diagnosis, wish, out, {}));
  out.json["headline"] = out.content.stated->headline;
  out.json["detail"] = out.content.stated->detail;
  if (wish.report) {
    compare_given(opened, out);
    compare_better(opened, diagnosis.final_fit, out);
    if (!diagnosis.effects.empty()) compare_refitted(opened, diagnosis.base_fit, out);
    out.json["where"] = lab::to_json(out.content.before.comparison)["where"];
  }
  out.content.diagnosis = std::move(diagnosis);
  return out;
}

Result<LabResult> fitted(const Case& opened, std::vector<std::string> effects, int threads,
                         const core::Progress& progress) {
  effects.insert(effects.end(), opened.own.begin(), opened.own.end());
  for (const std::string& id : effects) TRY(known(*opened.problem, id));
  std::ranges::sort(effects);
  effects.erase(std::unique(effects.begin(), effects.end()), effects.end());
  auto fit =
      TRY(lab::fit(*opened.problem, {effects}, {.threads = threads}, part_of(progress, 0.0, 0.9)));
  LabResult out = begun(opened);
  compare_given(opened, out);
  compare_better(opened, fit, out);
  if (!opened.own.empty())
    for (std::string& remark : lab::likenesses(
             *opened.problem, opened.own,
             std::span(fit.values).first(opened.problem->parameters({}).size()), threads))
      fit.remarks.push_back(std::move(remark));
  out.json = lab::to_json(fit, out.content.before.comparison);
  out.json["primary"] = opened.problem->channels().front().name;
  out.model = opened.problem->model(fit.structure, fit.values);
  out.content.fit = std::move(fit);
  return out;
}

}  // namespace lab_io
}  // namespace tractus
