#include "lab/report/answer.hpp"

#include <algorithm>
#include <cmath>

#include "effects/expression.hpp"
#include "lab/discover/table_effect.hpp"
#include "lab/identify/verdict_text.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Json;

Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(number(value));
  return out;
}

Json distribution(const Distribution& d) {
  return {{"mean", number(d.mean)},
          {"sd", number(d.sd)},
          {"p05", number(d.p05)},
          {"p50", number(d.p50)},
          {"p95", number(d.p95)},
          {"edges", numbers(d.histogram.edges)},
          {"shares", numbers(d.histogram.shares)}};
}

Json channel(const ChannelComparison& c) {
  return {{"name", c.name},
          {"rmse", number(c.rmse)},
          {"r2", number(c.r2)},
          {"noise_floor", number(c.noise_floor)},
          {"explained", number(c.explained)},
          {"bias", number(c.bias)},
          {"measured", distribution(c.measured)},
          {"simulated", distribution(c.simulated)},
          {"residual", distribution(c.residual)},
          {"spectrum", Json{{"frequency_Hz", numbers(c.spectrum.frequency_Hz)},
                            {"measured", numbers(c.spectrum.measured)},
                            {"simulated", numbers(c.spectrum.simulated)},
                            {"residual", numbers(c.spectrum.residual)}}}};
}

Json error_regions_json(const ErrorRegions& found) {
  Json out = Json::array();
  for (const Region& region : found.regions)
    out.push_back({{"region", region.text},
                   {"words", region.words},
                   {"share_of_error", region.share_of_error},
                   {"share_of_time", region.share_of_time},
                   {"rmse", number(region.rmse)},
                   {"mean", numbers(region.mean)}});
  return out;
}

Json one_or_many(const std::vector<double>& values) {
  return values.size() == 1 ? number(values[0]) : numbers(values);
}

Json effect(const FoundEffect& found) {
  Json parameters = Json::object();
  for (const FoundParameter& p : found.parameters)
    parameters[p.name] = {{"value", one_or_many(p.value)}, {"sd", one_or_many(p.sd)}};
  return {{"id", found.id}, {"probability", number(found.probability)}, {"parameters", parameters}};
}

Json discriminating_experiment_json(const std::optional<DiscriminatingExperiment>& experiment) {
  if (!experiment) return nullptr;
  return {
      {"between", experiment->between},
      {"recording", experiment->recording},
      {"expected_gain", experiment->expected_gain ? number(*experiment->expected_gain) : Json()}};
}

Json estimates(const Fit& fit) {
  Json out = Json::array();
  for (const Estimate& e : fit.estimates)
    out.push_back({{"name", e.pointer},
                   {"value", number(e.value)},
                   {"sd", number(e.sd)},
                   {"informed", e.informed},
                   {"at_bound", e.at_bound}});
  return out;
}

Json fitted_trials(const Fit& fit) {
  Json out = Json::array();
  for (const TrialError& t : fit.trials)
    out.push_back(
        {{"id", t.id}, {"rmse", number(t.rmse)}, {"held_out_rmse", number(t.held_out_rmse)}});
  return out;
}

/// Pairs of fitted numbers that are known only together.
Json strong_correlations(const Fit& fit) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < fit.correlation.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (std::abs(fit.correlation(i, j)) > 0.9)
        out.push_back({{"between", Json{fit.estimates[std::size_t(j)].pointer,
                                        fit.estimates[std::size_t(i)].pointer}},
                       {"correlation", number(fit.correlation(i, j))}});
  return out;
}

/// The fitted numbers of all effects, the model's own too, from pointers "id/name" and
/// "id/name/component".
Json fitted_effects(const Fit& fit) {
  std::vector<FoundEffect> found;
  for (const Estimate& e : fit.estimates) {
    const std::size_t slash = e.pointer.find('/');
    if (slash == 0 || slash == std::string::npos) continue;
    const std::string id = e.pointer.substr(0, slash), rest = e.pointer.substr(slash + 1);
    const std::string parameter = rest.substr(0, rest.find('/'));
    if (found.empty() || found.back().id != id) found.push_back({id, std::nan(""), {}});
    auto& parameters = found.back().parameters;
    if (parameters.empty() || parameters.back().name != parameter)
      parameters.push_back({parameter, {}, {}});
    parameters.back().value.push_back(e.value);
    parameters.back().sd.push_back(e.sd);
  }
  Json out = Json::array();
  for (const FoundEffect& one : found) {
    out.push_back(effect(one));
    out.back().erase("probability");
  }
  return out;
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json to_json(const Comparison& comparison) {
  Json channels = Json::array();
  const bool alone = std::ranges::any_of(
      comparison.channels, [&](const auto& c) { return c.name == comparison.judged_name; });
  if (!alone)
    channels.push_back({{"name", comparison.judged_name},
                        {"rmse", number(comparison.rmse)},
                        {"r2", number(comparison.r2)},
                        {"noise_floor", number(comparison.noise_floor)},
                        {"explained", number(comparison.explained)}});
  for (const ChannelComparison& c : comparison.channels) channels.push_back(channel(c));
  Json trials = Json::array();
  for (const TrialComparison& trial : comparison.trials) {
    Json by_channel = Json::object();
    for (std::size_t c = 0; c < comparison.channels.size(); ++c)
      by_channel[comparison.channels[c].name] = number(trial.channels[c]);
    trials.push_back({{"id", trial.id},
                      {"rmse", number(trial.rmse)},
                      {"channels", by_channel},
                      {"duration_s", trial.duration_s}});
  }
  Json phases = Json::array();
  for (const PhaseComparison& p : comparison.phases)
    phases.push_back({{"phase", p.phase},
                      {"rmse", number(p.rmse)},
                      {"share_of_error", p.share_of_error},
                      {"share_of_time", p.share_of_time},
                      {"judged_share", p.judged_share}});
  Json judgements = Json::array();
  for (const JudgementShare& j : comparison.judgements)
    judgements.push_back({{"judgement", name(j.judgement)}, {"share", j.share}});
  return {{"format", "tractus-comparison/1"},
          {"primary", comparison.judged_name},
          {"channels", channels},
          {"trials", trials},
          {"where", error_regions_json(comparison.error_regions)},
          {"where_method", comparison.error_regions.honest},
          {"phases", phases},
          {"judgements", judgements}};
}

Json to_json(const std::vector<Ranked>& ranking) {
  Json out = Json::array();
  for (const Ranked& ranked : ranking) {
    Json json{{"id", ranked.id},
              {"probability", number(ranked.probability)},
              {"held_out_rmse", ranked.held_out_rmse ? number(*ranked.held_out_rmse) : Json()}};
    if (!ranked.note.empty()) json["note"] = ranked.note;
    if (effects::is_expression(ranked.id)) json["own"] = true;
    for (const DetectionLimit& limit : ranked.detection_limits)
      json["detection_limits"].push_back({{"parameter", limit.parameter},
                                          {"value", limit.value ? number(*limit.value) : Json()},
                                          {"text", text_of(limit)}});
    out.push_back(std::move(json));
  }
  return out;
}

Json to_json(const TractMap& map) {
  const std::size_t across = map.angle_rad.empty() ? 0 : map.angle_rad.size() - 1;
  const auto table = [&](const std::vector<double>& cells) {
    Json out = Json::array();
    for (std::size_t at = 0; across > 0 && at < cells.size(); at += across)
      out.push_back(numbers(
          {cells.begin() + std::ptrdiff_t(at), cells.begin() + std::ptrdiff_t(at + across)}));
    return out;
  };
  return {{"depth_m", numbers(map.depth_m)},
          {"angle_rad", numbers(map.angle_rad)},
          {"rmse", table(map.rmse)},
          {"share", table(map.share)}};
}

Json to_json(const Diagnosis& d) {
  Json out{{"format", "tractus-diagnosis/1"},
           {"verdict", name(d.verdict)},
           {"probability", number(d.probability)},
           {"base", Json{{"rmse", number(d.base.rmse)},
                         {"held_out_rmse", number(d.base.held_out_rmse)},
                         {"noise_floor", number(d.base.noise_floor)}}}};
  for (const char* key : {"effects", "steps", "confounded"}) out[key] = Json::array();
  for (const FoundEffect& found : d.effects) out["effects"].push_back(effect(found));
  out["ranking"] = to_json(d.ranking);
  for (const Step& step : d.steps)
    out["steps"].push_back({{"model", step.model},
                            {"rmse", number(step.rmse)},
                            {"held_out_rmse", number(step.held_out_rmse)},
                            {"noise_floor", number(step.noise_floor)}});
  for (const auto& [a, b] : d.confounded) out["confounded"].push_back(Json{a, b});
  out["hypotheses"] = Json::array();
  for (const Hypothesis& h : d.hypotheses)
    out["hypotheses"].push_back({{"effects", h.structure.effects},
                                 {"probability", number(h.probability)},
                                 {"weight", number(h.weight)}});
  out["settle"] = discriminating_experiment_json(d.discriminating_experiment);
  out["depends_on"] = d.depends_on;
  out["rest_explained"] = number(d.dependence_explained);
  out["law_explained"] = number(d.law_explained);
  out["held_out"] = d.final_fit.folds;
  out["parameters"] = estimates(d.final_fit);
  out["trials"] = fitted_trials(d.final_fit);
  out["notes"] = d.notes;
  return out;
}

Json to_json(const Discovery& d) {
  Json proposals = Json::array();
  for (const Proposal& one : d.proposals) {
    Json terms = Json::array();
    for (const ProposedTerm& term : one.terms) {
      Json numbers_of_term = Json::object();
      for (const ProposedNumber& n : term.numbers)
        numbers_of_term[n.name] = {{"value", number(n.value)},
                                   {"unit", n.unit},
                                   {"low", number(n.low)},
                                   {"high", number(n.high)}};
      terms.push_back({{"formula", term.formula},
                       {"resembles", term.words},
                       {"numbers", std::move(numbers_of_term)},
                       {"effect", term.effect}});
    }
    proposals.push_back({{"formula", formula_text(one)},
                         {"terms", std::move(terms)},
                         {"beside", one.beside},
                         {"rmse", number(one.rmse)},
                         {"held_out_rmse", number(one.held_out_rmse)},
                         {"probability", one.probability},
                         {"stability", one.stability},
                         {"trials_improved", one.trials_improved},
                         {"size", one.size},
                         {"passive", one.passive}});
  }
  Json out{{"proposals", std::move(proposals)},
           {"formulas_tried", d.formulas_tried},
           {"catalogue_probability", d.catalogue_probability},
           {"unknown_probability", d.unknown_probability},
           {"unknown", nullptr},
           {"remark", d.remark}};
  if (!d.unknown) return out;
  Json knots = Json::array();
  for (const auto& of_signal : d.unknown->knots) knots.push_back(numbers(of_signal));
  out["unknown"] = {{"signals", d.unknown->signals},
                    {"units", d.unknown->units},
                    {"knots", std::move(knots)},
                    {"force_N", numbers(d.unknown->force_N)}};
  const auto effect = table_effect(*d.unknown, "expression:unknown_function");
  out["unknown"]["effect"] = effect ? *effect : Json();
  return out;
}

Json to_json(const Fit& fit, const Comparison& given) {
  return {{"format", "tractus-fit/1"},
          {"base", Json{{"rmse", number(given.rmse)}, {"noise_floor", number(given.noise_floor)}}},
          {"rmse", number(fit.rmse)},
          {"held_out_rmse", number(fit.held_out_rmse)},
          {"noise_floor", number(fit.noise_floor)},
          {"converged", fit.converged},
          {"held_out", fit.folds},
          {"effects", fitted_effects(fit)},
          {"parameters", estimates(fit)},
          {"correlations", strong_correlations(fit)},
          {"trials", fitted_trials(fit)},
          {"remarks", fit.remarks}};
}

}  // namespace lab
}  // namespace tractus
