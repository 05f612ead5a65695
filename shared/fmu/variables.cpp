#include "fmu/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Json;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// A number of the law, with what it means.
struct LawNumber {
  const char *name, *unit, *meaning;
};
constexpr std::array<LawNumber, 5> kLayerNumbers{{
    {"start_m", "m", "depth at which the layer begins"},
    {"thickness_m", "m", "thickness of the layer"},
    {"stiffness_N_per_m", "N/m", "K, stiffness of the layer"},
    {"damping_Ns_per_m", "N·s/m", "D, damping of the layer"},
    {"equilibrium_m", "m", "x0, depth at which the layer's spring is at rest"},
}};
constexpr std::array<LawNumber, 3> kRotaryNumbers{{
    {"viscous_Nms_per_rad", "N·m·s/rad", "V, viscous friction of the rotary stage"},
    {"detent_Nm", "N·m", "T, the most torque that a detent holds"},
    {"detent_pitch_rad", "rad", "p, angle from detent to detent"},
}};

std::vector<Variable> motion_and_forces() {
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

void add_law(const Json& base, std::vector<Variable>& out) {
  const auto add = [&](const LawNumber& n, const std::string& owner, const std::string& pointer,
                       const Json& numbers) {
    out.push_back({owner + n.name, Causality::parameter, n.unit, n.meaning,
                   numbers[n.name].get<double>(), -kNone, kNone, pointer + n.name});
  };
  const Json& layers = base["layers"];
  for (std::size_t k = 0; k < layers.size(); ++k)
    for (const LawNumber& n : kLayerNumbers)
      add(n, fmt::format("layers[{}].", k + 1), fmt::format("/base/layers/{}/", k), layers[k]);
  for (const LawNumber& n : kRotaryNumbers) add(n, "rotary.", "/base/rotary/", base["rotary"]);
}

/// A name of FMI's structured convention; one with other signs than letters, digits and _ is quoted.
std::string quoted(const std::string& id) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return std::ranges::all_of(id, plain) ? id : "'" + id + "'";
}

void add_effect(const effects::EffectInstance& use, std::size_t k, std::vector<Variable>& out) {
  const auto facts = effects::probing_facts(use);
  core::require(bool(facts), "a model's effects were checked as it was read");
  auto value = use.values.begin();
  for (const effects::Param& param : facts->params)
    for (int i = 0; i < param.components; ++i) {
      const bool one = param.components == 1;
      const std::string unit = effects::unit_of(param);
      out.push_back({fmt::format("effects.{}.{}", quoted(use.id), param.name) +
                         (one ? "" : fmt::format("[{}]", i + 1)),
                     Causality::parameter, unit == "1" ? "" : unit,
                     facts->label + (param.meaning.empty() ? "" : ": " + param.meaning), *value++,
                     param.low, param.high,
                     fmt::format("/effects/{}/parameters/{}", k, param.name) +
                         (one ? "" : fmt::format("/{}", i))});
    }
}

}  // namespace

std::vector<Variable> variables(const models::ProbingModel& model) {
  auto whole = model;
  whole.states_rotary = true;
  auto out = motion_and_forces();
  core::require(out.size() == kFirstParameter, "the places are those of the variables");
  add_law(whole.to_json()["base"], out);
  for (std::size_t k = 0; k < model.effects.size(); ++k) add_effect(model.effects[k], k, out);
  return out;
}

core::Result<models::ProbingModel> with_parameters(const models::ProbingModel& model,
                                                   std::span<const Variable> variables,
                                                   std::span<const double> values) {
  auto whole = model;
  whole.states_rotary = true;
  Json json = whole.to_json();
  for (std::size_t k = kFirstParameter; k < variables.size(); ++k)
    json[Json::json_pointer(variables[k].pointer)] = values[k];
  return models::ProbingModel::from_json(json, "parameters: ");
}

std::string carried_text(models::ProbingModel model) {
  model.states_rotary = true;
  return model.to_json().dump(1) + "\n";
}

std::string guid(std::string_view carried_text) {
  const std::string digest = core::sha256(core::bytes_of(carried_text));
  return fmt::format("{{{}-{}-{}-{}-{}}}", digest.substr(0, 8), digest.substr(8, 4),
                     digest.substr(12, 4), digest.substr(16, 4), digest.substr(20, 12));
}

}  // namespace fmu
}  // namespace tractus
