/// A model of the probing rig as an FMU: its variables, and the text that the FMU carries.
#pragma once

#include "core/result.hpp"
#include "fmu/variables.hpp"
#include "models/probing_model.hpp"

namespace tractus::fmu {

/// The first variables of every model of this rig, in this order; its parameters follow.
enum class ProbingPlace : std::size_t {
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

/// The start values are the model's numbers.
std::vector<Variable> variables(const models::ProbingModel& model);

/// The model with other numbers, one value per variable. Errors: bad_input or out_of_range naming
/// the parameter.
core::Result<models::ProbingModel> with_parameters(const models::ProbingModel& model,
                                                   std::span<const Variable> variables,
                                                   std::span<const double> values);

/// The model as an FMU carries it: every number is stated, in the order of `variables`.
std::string carried_text(models::ProbingModel model);

}  // namespace tractus::fmu
