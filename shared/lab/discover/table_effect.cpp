#include "lab/discover/table_effect.hpp"

#include <fmt/format.h>

#include "effects/expression.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Json;

/// c + Σ s_k |u − u_k| through the values at the knots. As the slope is 0 beyond either end, the s_k sum to 0.
std::string bends(const std::string& u, const std::vector<double>& knots,
                  const std::vector<double>& force_N) {
  const std::size_t n = knots.size();
  const auto slope = [&](std::size_t k) {  // before knot k
    return k == 0 || k == n ? 0.0 : (force_N[k] - force_N[k - 1]) / (knots[k] - knots[k - 1]);
  };
  double constant = force_N.front();
  std::string out;
  for (std::size_t k = 0; k < n; ++k) {
    const double half = 0.5 * (slope(k + 1) - slope(k));
    constant -= half * (knots[k] - knots.front());
    out += fmt::format(" + {:.6g} * abs({} - {:.6g})", half, u, knots[k]);
  }
  return fmt::format("{:.6g}{}", constant, out);
}

}  // namespace

std::optional<Json> table_effect(const UnknownFunction& function, const std::string& id) {
  if (function.signals.size() != 1 || function.knots.front().size() < 2) return std::nullopt;
  const auto& knots = function.knots.front();
  const std::string sum = bends(function.signals.front() + " / one", knots, function.force_N);
  Json effect{{"format", effects::kEffectFormat},
              {"id", id},
              {"rig", effects::probing_expressions().rig},
              {"adds_to", effects::probing_expressions().adds_to},
              {"formula", fmt::format("scale * ({})", sum)},
              {"summary", fmt::format("a table of {} places over {}, not a law", knots.size(),
                                      function.signals.front())},
              {"parameters",
               {{"scale",
                 {{"unit", "N"},
                  {"initial", 1.0},
                  {"low", -100.0},
                  {"high", 100.0},
                  {"meaning", "size of the table"}}},
                {"one",
                 {{"unit", function.units.front()},
                  {"initial", 1.0},
                  {"low", 1.0},
                  {"high", 1.0 + 1e-9},
                  {"meaning", "one of the signal's unit"}}}}}};
  if (!effects::Expression::from_json(effect, "", effects::probing_expressions()))
    return std::nullopt;
  return effect;
}

}  // namespace lab
}  // namespace tractus
