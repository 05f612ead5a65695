#include "lab/identify/parameter_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kStarts = kSettings.starts;

double node(const effects::Param& p, int k) {
  if (p.logarithmic)
    return p.low * std::pow(p.high / p.low, (k + 0.5) / double(kStarts.nodes_logarithmic));
  return p.low + (p.high - p.low) * (k + 0.5) / double(kStarts.nodes_linear);
}

const effects::EffectFacts* facts_of(const ParameterSpace& space, std::string_view effect) {
  for (const Candidate& candidate : space.candidates())
    if (candidate.facts.id == effect) return &candidate.facts;
  return nullptr;
}

/// Every start with each value of one more number behind it.
effects::Starts longer(const effects::Starts& starts, const std::vector<double>& values) {
  effects::Starts out;
  for (const auto& start : starts)
    for (const double value : values) {
      out.push_back(start);
      out.back().push_back(value);
    }
  if (out.size() > kStarts.most_starts) out.resize(kStarts.most_starts);
  return out;
}

/// The initial values, and a grid over the ranges of the numbers of shape.
effects::Starts grid(const effects::EffectFacts& facts) {
  effects::Starts out(1);
  if (facts.free_per_trial) return out;
  for (const effects::Param& p : facts.params) {
    std::vector<double> values;
    const int nodes = !std::isnan(p.off) ? 1
                      : p.logarithmic    ? kStarts.nodes_logarithmic
                                         : kStarts.nodes_linear;
    for (int k = 0; k < nodes; ++k) values.push_back(nodes == 1 ? p.initial : node(p, k));
    for (int c = 0; c < p.components; ++c) out = longer(out, values);
  }
  return out;
}

double step_of(const effects::Param& p, bool logarithmic) {
  if (p.step > 0.0) return p.step;
  if (logarithmic) return kStarts.step;
  return p.initial != 0.0 ? kStarts.step * std::abs(p.initial)
                          : 0.1 * kStarts.step * (p.high - p.low);
}

}  // namespace

std::vector<Parameter> parameters_of(const effects::EffectFacts& facts) {
  std::vector<Parameter> out;
  if (facts.free_per_trial) return out;
  for (const effects::Param& p : facts.params)
    for (int k = 0; k < p.components; ++k) {
      Parameter parameter;
      parameter.pointer = fmt::format("{}/{}", facts.id, p.name);
      if (p.components > 1) parameter.pointer += fmt::format("/{}", k);
      parameter.start = p.initial;
      parameter.low = p.low;
      parameter.high = p.high;
      parameter.logarithmic = p.logarithmic && p.low > 0.0;
      parameter.step = step_of(p, parameter.logarithmic);
      parameter.prior_sd = p.prior_sd;
      parameter.shape = std::isnan(p.off);
      if (!parameter.shape) parameter.off = p.off;
      // An angle of which every value is plausible.
      if (constexpr double kTurn = 2.0 * std::numbers::pi;
          effects::unit_of(p) == "rad" && p.high - p.low >= kTurn)
        parameter.period = kTurn;
      out.push_back(std::move(parameter));
    }
  return out;
}

effects::Starts ParameterSpace::starts(std::string_view effect, const Eigen::VectorXd&) const {
  const auto* facts = facts_of(*this, effect);
  if (!facts) return {};
  return facts->starts.empty() ? grid(*facts) : facts->starts;
}

std::string experiment_for(const ParameterSpace& space, std::string_view a, std::string_view b) {
  const auto* first = facts_of(space, a);
  const auto* second = facts_of(space, b);
  if (!first) return second ? second->experiment : "";
  if (!second || second->experiment == first->experiment) return first->experiment;
  return first->experiment + "; then " + second->experiment;
}

bool covers(std::string_view pattern, std::string_view pointer) {
  while (!pattern.empty() && !pointer.empty()) {
    const auto a = pattern.substr(0, pattern.find('/', 1));
    const auto b = pointer.substr(0, pointer.find('/', 1));
    if (a != b && a != "/*") return false;
    pattern.remove_prefix(a.size());
    pointer.remove_prefix(b.size());
  }
  return pattern.empty();
}

}  // namespace lab
}  // namespace tractus
