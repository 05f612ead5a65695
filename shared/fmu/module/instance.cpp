#include "fmu/module/instance.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr double kOfAStep = 1e-6;  // rounding between two importers' ways to add up time

}  // namespace

Instance::Instance(std::unique_ptr<Carried> carried)
    : carried_(std::move(carried)),
      variables_(carried_->variables()),
      order_(order_of(variables_)),
      state_(beginning()) {}

Result<std::unique_ptr<Instance>> Instance::make(std::string_view guid,
                                                 std::string_view resources) {
  auto carried = TRY(read_carried(guid, resources));
  return std::unique_ptr<Instance>(new Instance(std::move(carried)));
}

Instance::State Instance::beginning() const {
  State out;
  for (const Variable& v : variables_) out.values.push_back(v.start);
  out.derivatives.resize(order_.inputs);
  return out;
}

Result<void> Instance::expect(bool holds, const char* call) const {
  if (holds) return {};
  constexpr std::array kNames{"instantiated", "in initialization mode", "stepping", "terminated"};
  return Error{Errc::conflict, fmt::format("{} is not allowed while the model is {}", call,
                                           kNames[std::size_t(state_.phase)])};
}

Result<void> Instance::set_up(double start_s, std::optional<double> stop_s) {
  TRY(expect(state_.phase == Phase::instantiated, "fmi2SetupExperiment"));
  if (!std::isfinite(start_s) || (stop_s && !(*stop_s > start_s && std::isfinite(*stop_s))))
    return Error{Errc::bad_input,
                 fmt::format("fmi2SetupExperiment: from {} s to {} s: numbers are expected, the "
                             "stop after the start",
                             start_s, stop_s.value_or(start_s))};
  state_.start_s = state_.t_s = start_s;
  state_.stop_s = stop_s;
  return {};
}

Result<void> Instance::begin_initialization() {
  TRY(expect(state_.phase == Phase::instantiated, "fmi2EnterInitializationMode"));
  state_.phase = Phase::initializing;
  return {};
}

Result<void> Instance::end_initialization() {
  TRY(expect(state_.phase == Phase::initializing, "fmi2ExitInitializationMode"));
  TRY(prepare());
  state_.phase = Phase::stepping;
  return {};
}

Result<void> Instance::check(unsigned int reference, double value) const {
  if (reference >= variables_.size())
    return Error{Errc::bad_input, fmt::format("value reference {}: there are {} variables",
                                              reference, variables_.size())};
  const Variable& v = variables_[reference];
  if (v.causality == Causality::output)
    return Error{Errc::bad_input, fmt::format("{}: an output cannot be set", v.name)};
  if (v.causality == Causality::parameter && state_.phase > Phase::initializing)
    return Error{Errc::conflict,
                 fmt::format("{}: a parameter is fixed once the model was initialized", v.name)};
  if (!std::isfinite(value) || value < v.low || value > v.high)
    return Error{Errc::out_of_range, fmt::format("{}: {} where a number in {} … {} is expected",
                                                 v.name, value, v.low, v.high)};
  return {};
}

Result<void> Instance::set(References references, const double* values) {
  for (std::size_t k = 0; k < references.size(); ++k) TRY(check(references[k], values[k]));
  for (std::size_t k = 0; k < references.size(); ++k) {
    state_.values[references[k]] = values[k];
    if (references[k] >= order_.first_parameter) state_.simulation.reset();
  }
  return {};
}

Result<void> Instance::set_derivatives(References references, const int* orders,
                                       const double* values) {
  for (std::size_t k = 0; k < references.size(); ++k)
    if (references[k] >= order_.inputs || orders[k] != 1 || !std::isfinite(values[k]))
      return Error{
          Errc::bad_input,
          fmt::format(
              "fmi2SetRealInputDerivatives: reference {}, order {}, value {}: a first derivative "
              "of an input is expected",
              references[k], orders[k], values[k])};
  for (std::size_t k = 0; k < references.size(); ++k) state_.derivatives[references[k]] = values[k];
  return {};
}

/// Makes the model run with the parameters as they stand, unless it does.
Result<void> Instance::prepare() {
  if (state_.simulation) return {};
  state_.simulation = TRY(carried_->simulation(state_.values, state_.start_s, state_.stop_s));
  return {};
}

Result<std::vector<double>> Instance::outputs() {
  TRY(expect(state_.phase != Phase::instantiated, "reading a force"));
  TRY(prepare());
  return state_.simulation->outputs(state_.t_s, state_.values);
}

Result<void> Instance::get(References references, double* values) {
  std::vector<double> found;
  for (std::size_t k = 0; k < references.size(); ++k) {
    if (references[k] >= variables_.size())
      return Error{Errc::bad_input, fmt::format("value reference {}: there are {} variables",
                                                references[k], variables_.size())};
    if (variables_[references[k]].causality != Causality::output) {
      values[k] = state_.values[references[k]];
      continue;
    }
    if (found.empty()) found = TRY(outputs());
    values[k] = found[references[k] - order_.inputs];
  }
  return {};
}

Result<void> Instance::step(double t_s, double length_s) {
  TRY(expect(state_.phase == Phase::stepping, "fmi2DoStep"));
  if (!std::isfinite(t_s) || !(length_s > 0.0) || !std::isfinite(length_s) ||
      !(t_s + length_s > t_s))
    return Error{
        Errc::bad_input,
        fmt::format("fmi2DoStep: a step of {} s at {} s: more than 0 is expected", length_s, t_s)};
  if (std::abs(t_s - state_.t_s) > kOfAStep * length_s + 1e-12 * std::abs(t_s))
    return Error{
        Errc::bad_input,
        fmt::format("fmi2DoStep: a step from {} s, but the model is at {} s", t_s, state_.t_s)};
  if (length_s > carried_->longest_step_s())
    return Error{Errc::bad_input,
                 fmt::format("fmi2DoStep: a step of {} s at {} s: at most {} s is expected",
                             length_s, t_s, carried_->longest_step_s())};
  TRY(state_.simulation->keep(t_s, state_.values));
  for (std::size_t k = 0; k < order_.inputs; ++k)
    state_.values[k] += length_s * state_.derivatives[k];
  state_.t_s = t_s + length_s;
  return {};
}

Result<void> Instance::terminate() {
  TRY(expect(state_.phase == Phase::stepping, "fmi2Terminate"));
  state_.phase = Phase::terminated;
  return {};
}

std::unique_ptr<Instance::State> Instance::state() const {
  return std::make_unique<State>(copy_of(state_));
}
void Instance::restore(const State& state) { state_ = copy_of(state); }

Instance::State Instance::copy_of(const State& state) {
  return {state.phase,
          state.values,
          state.derivatives,
          state.start_s,
          state.t_s,
          state.stop_s,
          state.simulation ? state.simulation->copy() : nullptr};
}

}  // namespace fmu
}  // namespace tractus
