/// What a model looks like from outside as an FMU: inputs, outputs and parameters.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/named.hpp"
#include "core/result.hpp"
#include "models/probing_model.hpp"

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

/// The first variables of every model, in this order; its parameters follow. A variable's index is
/// its value reference.
enum class Place : std::size_t {
  x_m,
  v_m_s,
  a_m_s2,
  theta_rad,
  omega_rad_s,
  recorded_tz_Nm,
  rest_m_s,
  rest_rad_s,
  fz_N,
  tz_Nm,
  first_parameter
};
inline constexpr std::size_t kInputs = std::size_t(Place::fz_N);
inline constexpr std::size_t kFirstParameter = std::size_t(Place::first_parameter);

/// The start values are the model's numbers.
std::vector<Variable> variables(const models::ProbingModel& model);

/// The model with other numbers, one value per variable. Errors: bad_input or out_of_range naming
/// the parameter.
core::Result<models::ProbingModel> with_parameters(const models::ProbingModel& model,
                                                   std::span<const Variable> variables,
                                                   std::span<const double> values);

/// The model as an FMU carries it: every number is stated, in the order of `variables`.
std::string carried_text(models::ProbingModel model);
/// {8-4-4-4-12}, of the digest of that text.
std::string guid(std::string_view carried_text);

}  // namespace tractus::fmu
