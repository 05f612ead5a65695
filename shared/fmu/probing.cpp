#include "fmu/probing.hpp"

#include <fmt/format.h>

#include "core/require.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Json;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A number of the probing law, with what it means.
struct LayerNumber {
  const char *name, *unit, *meaning;
};
constexpr std::array<LayerNumber, 5> kLayerNumbers{{
    {"start_m", "m", "depth at which the layer begins"},
    {"thickness_m", "m", "thickness of the layer"},
    {"stiffness_N_per_m", "N/m", "K, stiffness of the layer"},
    {"damping_Ns_per_m", "N·s/m", "D, damping of the layer"},
    {"equilibrium_m", "m", "x0, depth at which the layer's spring is at rest"},
}};
constexpr std::array<LayerNumber, 3> kRotaryNumbers{{
    {"viscous_Nms_per_rad", "N·m·s/rad", "V, viscous friction of the rotary stage"},
    {"detent_Nm", "N·m", "T, the most torque that a detent holds"},
    {"detent_pitch_rad", "rad", "p, angle from detent to detent"},
}};

std::vector<Variable> probing_motion_and_forces() {
  using enum Causality;
  const effects::ProbingMotion usual;
  return {
      {"x_m", input, "m", "depth of the tip, positive into the bone"},
      {"v_m_s", input, "m/s", "speed of the tip, positive into the bone"},
      {"a_m_s2", input, "m/s²", "acceleration of the tip"},
      {"theta_rad", input, "rad", "turning about x"},
      {"omega_rad_s", input, "rad/s", "speed of the turning"},
      {"recorded_tz_Nm", input, "N·m",
       "torque that the sensor recorded, of which a sensor with crosstalk shows a part as force"},
      {"rest_m_s", input, "m/s", "speed below which v_m_s counts as rest: dry friction is 0 there",
       usual.rest_m_s, 0.0},
      {"rest_rad_s", input, "rad/s", "the same of omega_rad_s", usual.rest_rad_s, 0.0},
      {"fz_N", output, "N", "push of the hand along x that the motion asks for"},
      {"tz_Nm", output, "N·m", "torque of the hand about x that the turning asks for"},
  };
}

void add_layers(const Json& base, std::vector<Variable>& out) {
  const auto add = [&](const LayerNumber& n, const std::string& owner, const std::string& pointer,
                       const Json& numbers) {
    out.push_back({owner + n.name, Causality::parameter, n.unit, n.meaning,
                   numbers[n.name].get<double>(), -kUnbounded, kUnbounded, pointer + n.name});
  };
  const Json& layers = base["layers"];
  for (std::size_t k = 0; k < layers.size(); ++k)
    for (const LayerNumber& n : kLayerNumbers)
      add(n, fmt::format("layers[{}].", k + 1), fmt::format("/base/layers/{}/", k), layers[k]);
  for (const LayerNumber& n : kRotaryNumbers) add(n, "rotary.", "/base/rotary/", base["rotary"]);
}

}  // namespace

std::vector<Variable> variables(const models::ProbingModel& model) {
  auto whole = model;
  whole.states_rotary = true;
  auto out = probing_motion_and_forces();
  core::require(out.size() == std::size_t(ProbingPlace::first_parameter),
                "the places are those of the variables");
  add_layers(whole.to_json()["base"], out);
  for (std::size_t k = 0; k < model.effects.size(); ++k) {
    const auto facts = effects::probing_facts(model.effects[k]);
    core::require(bool(facts), "a model's effects were checked as it was read");
    add_effect(model.effects[k], *facts, k, out);
  }
  return out;
}

core::Result<models::ProbingModel> with_parameters(const models::ProbingModel& model,
                                                   std::span<const Variable> variables,
                                                   std::span<const double> values) {
  auto whole = model;
  whole.states_rotary = true;
  return models::ProbingModel::from_json(with_values(whole.to_json(), variables, values),
                                         "parameters: ");
}

std::string carried_text(models::ProbingModel model) {
  model.states_rotary = true;
  return model.to_json().dump(1) + "\n";
}

}  // namespace fmu
}  // namespace tractus
