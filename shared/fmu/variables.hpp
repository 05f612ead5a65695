/// What a model looks like from outside as an FMU: inputs, outputs and parameters, in this order.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/named.hpp"
#include "effects/effect.hpp"

namespace tractus::fmu {

/// FMI's `causality`.
enum class Causality { input, output, parameter };
constexpr auto words(Causality) {
  return std::to_array<core::Word<Causality>>({{Causality::input, "input"},
                                               {Causality::output, "output"},
                                               {Causality::parameter, "parameter"}});
}
using core::name;

struct Variable {
  std::string name;  ///< "x_m", "layers[1].stiffness_N_per_m", "effects.ID.PARAMETER"
  Causality causality;
  std::string unit, description;
  double start = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string pointer = {};  ///< of a parameter: where it stands in the model's JSON
};

/// How many inputs lead the variables, and where the parameters begin. A variable's index is its value
/// reference.
struct Order {
  std::size_t inputs = 0, first_parameter = 0;
};
Order order_of(std::span<const Variable> variables);

/// Adds the parameters of an effect, the `k`th of its model.
void add_effect(const effects::EffectInstance& use, const effects::EffectFacts& facts,
                std::size_t k, std::vector<Variable>& out);

/// A model's JSON with other numbers, one value per variable.
core::Json with_values(core::Json model, std::span<const Variable> variables,
                       std::span<const double> values);

/// {8-4-4-4-12}, of the digest of the texts that an FMU carries.
std::string guid(std::string_view carried_text);

}  // namespace tractus::fmu
