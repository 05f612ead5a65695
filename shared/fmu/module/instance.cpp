#include "fmu/module/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/file.hpp"
#include "core/json.hpp"
#include "core/try.hpp"
#include "effects/probing_effect.hpp"
#include "fmu/module/file_uri.hpp"

namespace tractus {
namespace fmu {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr double kTravel_m = 1.0;  // the motion says how far it goes, as in a replay
constexpr double kOfAStep = 1e-6;  // rounding between two importers' ways to add up time
constexpr std::uint64_t kMostBytes = 64ull << 20;

Result<models::ProbingModel> read_carried(std::string_view guid_given, std::string_view resources) {
  const fs::path path = TRY(path_of(resources)) / "model.json";
  const auto bytes = TRY(core::read_file(path, kMostBytes));
  const std::string_view text = core::text_of(bytes);
  if (guid(text) != guid_given)
    return Error{Errc::corrupt,
                 fmt::format("{}: changed since the export, or of another model than guid {}",
                             path.string(), guid_given.substr(0, 60))};
  const auto json = TRY(core::parse_json(text, path.string()));
  return models::ProbingModel::from_json(json, path.string() + ": ");
}

}  // namespace

Instance::Instance(models::ProbingModel model, std::vector<Variable> variables)
    : model_(std::move(model)), variables_(std::move(variables)), state_(beginning()) {}

Result<std::unique_ptr<Instance>> Instance::make(std::string_view guid,
                                                 std::string_view resources) {
  auto model = TRY(read_carried(guid, resources));
  auto all = variables(model);
  return std::unique_ptr<Instance>(new Instance(std::move(model), std::move(all)));
}

Instance::State Instance::beginning() const {
  State out;
  for (const Variable& v : variables_) out.values.push_back(v.start);
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
    if (references[k] >= kFirstParameter) state_.stream.reset();
  }
  return {};
}

Result<void> Instance::set_derivatives(References references, const int* orders,
                                       const double* values) {
  for (std::size_t k = 0; k < references.size(); ++k)
    if (references[k] >= kInputs || orders[k] != 1 || !std::isfinite(values[k]))
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
  if (state_.stream) return {};
  const auto model = TRY(with_parameters(model_, variables_, state_.values));
  for (const effects::EffectInstance& use : model.effects) {
    const auto facts = TRY(effects::probing_facts(use));
    if (facts.free_per_trial && !state_.stop_s)
      return Error{Errc::bad_input, fmt::format("{} runs over the whole trial: fmi2SetupExperiment "
                                                "must give the stop time",
                                                use.id)};
  }
  auto runtime = TRY(models::ProbingRuntime::make(model, kTravel_m));
  state_.runtime = std::make_shared<const models::ProbingRuntime>(std::move(runtime));
  state_.stream.emplace(*state_.runtime, state_.start_s, state_.stop_s.value_or(state_.start_s));
  return {};
}

effects::ProbingTick Instance::tick() const noexcept {
  const auto at = [this](Place place) { return state_.values[std::size_t(place)]; };
  return {.t_s = state_.t_s,
          .x_m = at(Place::x_m),
          .v_m_s = at(Place::v_m_s),
          .a_m_s2 = at(Place::a_m_s2),
          .theta_rad = at(Place::theta_rad),
          .omega_rad_s = at(Place::omega_rad_s),
          .tz_Nm = at(Place::recorded_tz_Nm),
          .rest_m_s = at(Place::rest_m_s),
          .rest_rad_s = at(Place::rest_rad_s)};
}

Result<models::ProbingAnswer> Instance::answer() {
  TRY(expect(state_.phase != Phase::instantiated, "reading a force"));
  TRY(prepare());
  const auto out = state_.stream->at(tick());
  if (!std::isfinite(out.fz_N) || !std::isfinite(out.tz_Nm))
    return Error{Errc::out_of_range,
                 fmt::format("fz_N = {}, tz_Nm = {} at {} s: the motion is beyond all measure",
                             out.fz_N, out.tz_Nm, state_.t_s)};
  return out;
}

Result<void> Instance::get(References references, double* values) {
  std::optional<models::ProbingAnswer> forces;
  for (std::size_t k = 0; k < references.size(); ++k) {
    if (references[k] >= variables_.size())
      return Error{Errc::bad_input, fmt::format("value reference {}: there are {} variables",
                                                references[k], variables_.size())};
    if (variables_[references[k]].causality != Causality::output) {
      values[k] = state_.values[references[k]];
      continue;
    }
    if (!forces) forces = TRY(answer());
    values[k] = references[k] == unsigned(Place::fz_N) ? forces->fz_N : forces->tz_Nm;
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
  state_.t_s = t_s;
  state_.stream->keep(tick());
  for (std::size_t k = 0; k < kInputs; ++k) state_.values[k] += length_s * state_.derivatives[k];
  state_.t_s = t_s + length_s;
  return {};
}

Result<void> Instance::terminate() {
  TRY(expect(state_.phase == Phase::stepping, "fmi2Terminate"));
  state_.phase = Phase::terminated;
  return {};
}

std::unique_ptr<Instance::State> Instance::state() const { return std::make_unique<State>(state_); }
void Instance::restore(const State& state) { state_ = state; }

}  // namespace fmu
}  // namespace tractus
