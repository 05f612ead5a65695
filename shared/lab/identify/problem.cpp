#include "lab/identify/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace lab {
namespace {

constexpr int kNodesLogarithmic = 8, kNodesLinear = 4;
constexpr std::size_t kMostStarts = 64;
constexpr double kStep = 0.01;  // of the initial value, or of the logarithm

double node(const effects::Param& p, int k) {
  if (p.logarithmic) return p.low * std::pow(p.high / p.low, (k + 0.5) / double(kNodesLogarithmic));
  return p.low + (p.high - p.low) * (k + 0.5) / double(kNodesLinear);
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
      parameter.step = parameter.logarithmic ? kStep
                       : p.initial != 0.0    ? kStep * std::abs(p.initial)
                                             : 0.1 * kStep * (p.high - p.low);
      parameter.shape = std::isnan(p.off);
      if (!parameter.shape) parameter.off = p.off;
      out.push_back(std::move(parameter));
    }
  return out;
}

void Problem::residuals_near(const Structure& structure, std::span<const double>,
                             const std::vector<std::vector<double>>& points, int trial,
                             Eigen::Ref<Eigen::MatrixXd> out) const {
  for (std::size_t k = 0; k < points.size(); ++k)
    residuals(structure, points[k], trial, out.col(Eigen::Index(k)));
}

std::vector<std::vector<double>> Problem::starts(std::string_view effect,
                                                 const Eigen::VectorXd&) const {
  std::vector<std::vector<double>> out;
  for (const Candidate& candidate : candidates()) {
    if (candidate.facts.id != effect) continue;
    out.emplace_back();
    if (candidate.facts.free_per_trial) return out;
    for (const effects::Param& p : candidate.facts.params)
      for (int c = 0; c < p.components; ++c) {
        const int nodes = !std::isnan(p.off) ? 1 : p.logarithmic ? kNodesLogarithmic : kNodesLinear;
        std::vector<std::vector<double>> longer;
        for (const auto& start : out)
          for (int k = 0; k < nodes; ++k) {
            longer.push_back(start);
            longer.back().push_back(nodes == 1 ? p.initial : node(p, k));
          }
        if (longer.size() > kMostStarts) longer.resize(kMostStarts);
        out = std::move(longer);
      }
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
