#include "lab/discover/formula_effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "effects/expression.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Json;

constexpr double kNinetyPercent = 1.6449;  // standard errors to either side

/// A power of ten well above the amount.
double far_above(double value) {
  return std::pow(10.0, std::ceil(std::log10(std::max(std::abs(value), 1e-9))) + 2.0);
}

Json amplitude_json(const Term& term, double value, double reach) {
  return {{"unit", term.amplitude.text()},
          {"initial", value},
          {"low", -reach},
          {"high", reach},
          {"meaning", "size and sign of the term"}};
}

Json number_json(const FactorNumber& number, double value) {
  Json out{{"unit", number.unit},
           {"initial", std::clamp(value, number.low, number.high)},
           {"low", number.low},
           {"high", number.high},
           {"meaning", number.meaning}};
  if (number.logarithmic) out["logarithmic"] = true;
  return out;
}

Json effect_file(const std::string& id, const Term& term, const std::string& words,
                 Json parameters) {
  return {{"format", effects::kEffectFormat},
          {"id", id},
          {"rig", effects::probing_expressions().rig},
          {"adds_to", effects::probing_expressions().adds_to},
          {"formula", formula_of(term)},
          {"summary", words},
          {"parameters", std::move(parameters)}};
}

}  // namespace

FormulaEffect formula_effect(const std::string& id, const Term& term,
                             const std::vector<Factor>& factors, double amplitude) {
  FormulaEffect out{id, term, numbers_of(term, factors), {}, {}};
  if (amplitude == 0.0) amplitude = 1e-6;
  Json parameters = Json::object();
  parameters["amplitude"] = amplitude_json(term, amplitude, far_above(amplitude));
  std::vector<double> start{amplitude};
  for (const FactorNumber& number : out.numbers) {
    parameters[number.name] = number_json(number, number.value);
    start.push_back(number.value);
  }
  const auto made = effects::Expression::from_json(
      effect_file(id, term, words_of(term, factors), std::move(parameters)), id + ": ",
      effects::probing_expressions());
  core::require(bool(made), made ? "" : made.error().what.c_str());
  out.use = made->use();
  out.facts = made->facts();
  out.facts.starts = {start};
  return out;
}

ProposedTerm proposed_term(const FormulaEffect& effect, const std::vector<Factor>& factors,
                           const Fit& fit, const std::string& id) {
  ProposedTerm out{formula_of(effect.term), words_of(effect.term, factors), {}, {}};
  Json parameters = Json::object();
  for (const effects::Param& param : effect.facts.params) {
    const auto at =
        std::ranges::find(fit.estimates, effect.id + "/" + param.name, &Estimate::pointer);
    core::require(at != fit.estimates.end(), "a fitted effect has its numbers");
    ProposedNumber number{param.name, param.unit, param.meaning, at->value};
    const double reach = kNinetyPercent * at->sd;
    const bool factor = param.logarithmic && at->value > 0.0;
    number.low = factor ? at->value * std::exp(-reach / at->value) : at->value - reach;
    number.high = factor ? at->value * std::exp(reach / at->value) : at->value + reach;
    const auto known = std::ranges::find(effect.numbers, param.name, &FactorNumber::name);
    parameters[param.name] =
        known == effect.numbers.end()
            ? amplitude_json(effect.term, at->value, std::max(far_above(at->value), param.high))
            : number_json(*known, at->value);
    out.numbers.push_back(std::move(number));
  }
  out.effect = effect_file(id, effect.term, out.words, std::move(parameters));
  return out;
}

}  // namespace lab
}  // namespace tractus
