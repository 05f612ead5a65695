#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/expression.hpp"
#include "lab/rigs/probing/probing_problem.hpp"

namespace tractus {
namespace lab {
namespace {

/// The resistance of the bone over a motion, N, as a formula is told it.
std::vector<double> resistance_N(models::ProbingModel model, const effects::ProbingMotion& motion) {
  std::erase_if(model.effects, [](const effects::EffectInstance& use) {
    const auto* info = effects::find_probing_effect(use.id);
    return !info || info->facts.kind == effects::Kind::measurement;
  });
  const auto without = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  const auto base = effects::Expression::from_json(
      {{"format", effects::kEffectFormat},
       {"id", "expression:base"},
       {"rig", "probing"},
       {"adds_to", "fz_N"},
       {"formula", "c * base_N"},
       {"parameters", {{"c", {{"unit", "1"}, {"initial", 1}, {"low", 0}, {"high", 2}}}}}},
      "", effects::probing_expressions());
  core::require(bool(base), "a formula of one product is right");
  model.effects.push_back(base->use());
  const auto with = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  core::require(without && with, "values within their bounds make a model that runs");
  models::ProbingForces once, twice;
  without->predict(motion, once);
  with->predict(motion, twice);
  for (std::size_t k = 0; k < once.fz_N.size(); ++k) twice.fz_N[k] -= once.fz_N[k];
  return std::move(twice.fz_N);
}

bool contains_id(const Structure& structure, const std::string& id) {
  return std::ranges::find(structure.effects, id) != structure.effects.end();
}

}  // namespace

FormulaSignals ProbingProblem::signals(const Structure& structure, std::span<const double> values,
                                       int k) const {
  const effects::ProbingMotion& m = trial(k).motion;
  FormulaSignals out;
  out.states = {
      m.x_m,         m.v_m_s, m.a_m_s2, m.theta_rad,
      m.omega_rad_s, m.t_s,   m.tz_Nm,  resistance_N(numbers_.with(structure, values), m)};
  for (double& v : out.states[1])
    if (std::abs(v) <= m.rest_m_s) v = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i)
    out.steps.push_back({i == 0 ? 0.0 : m.t_s[i] - m.t_s[i - 1], m.rest_m_s});
  return out;
}

void ProbingProblem::response(const Structure& structure, int k, std::span<const double> added,
                              Eigen::Ref<Eigen::VectorXd> out) const {
  const ProbingRecording& r = trial(k);
  r.decimator.apply(added, std::span(out.data(), std::size_t(out.size())));
  for (Eigen::Index j = 0; j < out.size(); ++j) out(j) /= -r.sd_thin[std::size_t(j)];
  if (has_drift(structure)) drifts_[std::size_t(k)].remove(out);
}

std::vector<bool> ProbingProblem::moving(int k) const {
  const ProbingRecording& r = trial(k);
  std::vector<double> share(r.measured_thin.size());
  const std::vector<double> one(r.rest.size(), 1.0);
  r.decimator.apply_sizes(r.rest, one, share);
  std::vector<bool> out;
  for (const double s : share) out.push_back(s < kProbingRecording.least_moving_rest);
  return out;
}

FormulaTerms::Work ProbingProblem::work_of_cycles(const Structure& structure,
                                                  std::span<const double> values) const {
  models::ProbingModel model = numbers_.with(structure, values), base = model;
  std::erase_if(base.effects, [&](const effects::EffectInstance& use) {
    return effects::is_expression(use.id) && contains_id(structure, use.id);
  });
  const auto with = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  const auto without = models::ProbingRuntime::make(base, kProbingRecording.longest_model_m);
  core::require(with && without, "values within their bounds make a model that runs");
  double least_m = 1e9, most_m = -1e9, fastest_m_s = 1e-4;
  for (const ProbingRecording& r : trials_) {
    const auto [a, b] = std::ranges::minmax(r.motion.x_m);
    least_m = std::min(least_m, a), most_m = std::max(most_m, b);
    for (const double v : r.motion.v_m_s) fastest_m_s = std::max(fastest_m_s, std::abs(v));
  }
  const double half_m = 0.5 * (most_m - least_m), middle_m = 0.5 * (most_m + least_m);
  constexpr int kSamples = 4000;  // of a cycle
  Work out{std::numeric_limits<double>::infinity(), 0.0};
  for (const double share : {0.1, 0.8}) {
    const double w = share * fastest_m_s / half_m;
    effects::ProbingMotion m{.rest_m_s = 0.0};
    for (int i = 0; i <= 3 * kSamples; ++i) {
      const double t = 2.0 * std::numbers::pi * i / kSamples / w;
      m.t_s.push_back(t);
      m.x_m.push_back(middle_m - half_m * std::cos(w * t));
      m.v_m_s.push_back(half_m * w * std::sin(w * t));
      m.a_m_s2.push_back(half_m * w * w * std::cos(w * t));
    }
    models::ProbingForces all, own;
    with->predict(m, all);
    without->predict(m, own);
    double taken_J = 0.0, turned_J = 0.0;
    for (std::size_t i = 2 * kSamples + 1; i < m.size(); ++i) {
      const double mean_N = 0.5 * (all.fz_N[i] + all.fz_N[i - 1] - own.fz_N[i] - own.fz_N[i - 1]);
      const double step_J = mean_N * (m.x_m[i] - m.x_m[i - 1]);
      taken_J += step_J, turned_J += std::abs(step_J);
    }
    if (taken_J < out.taken_J) out = {taken_J, turned_J};
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
