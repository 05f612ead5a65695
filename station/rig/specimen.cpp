#include "station/rig/specimen.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace rig {
namespace {

constexpr double kCreep_m_s = 2e-4;  // below it dry friction has not reached its size

core::Result<double> number_of(const core::Json& json, const char* field,
                               const std::string& where) {
  const auto it = json.find(field);
  if (it == json.end() || !it->is_number() || !std::isfinite(it->get<double>()))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}{}: a number is expected", where, field)};
  return it->get<double>();
}

}  // namespace

core::Result<Specimen> Specimen::from_json(const core::Json& json, const std::string& where) {
  const auto wrong = [&](const char* what) {
    return core::Error{core::Errc::bad_input, where + what};
  };
  if (!json.is_object() || json.value("format", "") != "tractus-specimen/1")
    return wrong("format: \"tractus-specimen/1\" is expected");
  const auto layers = json.find("layers");
  if (layers == json.end() || !layers->is_array() || layers->empty())
    return wrong("layers: at least one layer is expected");
  Specimen out;
  for (std::size_t k = 0; k < layers->size(); ++k) {
    const std::string at = fmt::format("{}layers/{}/", where, k);
    const core::Json& layer = (*layers)[k];
    if (!layer.is_object())
      return core::Error{core::Errc::bad_input, at + ": an object is expected"};
    out.layers_.push_back({TRY(number_of(layer, "from_m", at)), TRY(number_of(layer, "to_m", at)),
                           TRY(number_of(layer, "stiffness_N_per_m", at)),
                           TRY(number_of(layer, "damping_Ns_per_m", at)),
                           TRY(number_of(layer, "equilibrium_m", at))});
  }
  if (json.contains("friction_N")) out.friction_N_ = TRY(number_of(json, "friction_N", where));
  return out;
}

double Specimen::push_N(double x_m, double v_m_s) const noexcept {
  for (const Layer& layer : layers_)
    if (x_m >= layer.from_m && x_m < layer.to_m)
      return layer.stiffness_N_per_m * (x_m - layer.equilibrium_m) +
             layer.damping_Ns_per_m * v_m_s + friction_N_ * std::tanh(v_m_s / kCreep_m_s);
  return 0.0;
}

}  // namespace rig
}  // namespace tractus
