/// What an instance of an exported model runs; the rigs differ in it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "fmu/palpation.hpp"
#include "fmu/probing.hpp"

namespace tractus::fmu {

/// A model with its parameters, run along a motion. A call that is refused changes nothing.
class Simulation {
 public:
  virtual ~Simulation() = default;
  /// One that goes on from where this stands.
  virtual std::unique_ptr<Simulation> copy() const = 0;
  /// The outputs, in the order of the variables, where the motion at t is `values`, one per variable.
  virtual core::Result<std::vector<double>> outputs(double t_s, std::span<const double> values) = 0;
  /// The motion has passed that moment.
  virtual core::Result<void> keep(double t_s, std::span<const double> values) = 0;
};

/// What the folder `resources` of an FMU holds.
class Carried {
 public:
  virtual ~Carried() = default;
  std::span<const Variable> variables() const noexcept { return variables_; }
  /// @param values  one per variable. @param stop_s  nothing if the importer does not know it.
  /// Errors: bad_input or out_of_range naming the parameter.
  virtual core::Result<std::unique_ptr<Simulation>> simulation(
      std::span<const double> values, double start_s, std::optional<double> stop_s) const = 0;
  /// Of a communication step.
  virtual double longest_step_s() const noexcept { return std::numeric_limits<double>::infinity(); }

 protected:
  explicit Carried(std::vector<Variable> variables) : variables_(std::move(variables)) {}

 private:
  std::vector<Variable> variables_;
};

/// @param guid  that the importer read. @param resources  URI of the folder.
/// Errors: bad_input, not_found, io, corrupt (another model than the guid's).
core::Result<std::unique_ptr<Carried>> read_carried(std::string_view guid,
                                                    std::string_view resources);

std::unique_ptr<Carried> carried(models::ProbingModel model);
/// Errors: too_large for want of memory.
core::Result<std::unique_ptr<Carried>> carried(models::PalpationModel model,
                                               const CarriedField& field);

}  // namespace tractus::fmu
