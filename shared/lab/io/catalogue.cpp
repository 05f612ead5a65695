#include "lab/io/catalogue.hpp"

#include <cmath>

#include "core/require.hpp"
#include "core/try.hpp"
#include "effects/palpation_effect.hpp"
#include "effects/palpation_expression.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace lab_io {
namespace {

using core::Json;

Json number_or_null(double value) { return std::isnan(value) ? Json() : Json(value); }

const effects::ExpressionRig& formulas_of(std::string_view rig) {
  return rig == "probing" ? effects::probing_expressions() : effects::palpation_expressions();
}

/// Where the effect shows; the palpation rig has forces alone.
Json channel_json(std::string_view rig, effects::Channel channel) {
  if (rig != "probing") return {};
  return channel == effects::Channel::torque ? "tz_Nm" : "fz_N";
}

}  // namespace

Json effect_json(std::string_view rig, const effects::EffectFacts& facts) {
  Json parameters = Json::array();
  for (const effects::Param& p : facts.params)
    parameters.push_back({{"name", p.name},
                          {"unit", effects::unit_of(p)},
                          {"meaning", p.meaning},
                          {"components", p.components},
                          {"initial", p.initial},
                          {"low", p.low},
                          {"high", p.high},
                          {"off", number_or_null(p.off)},
                          {"if_missing", number_or_null(p.if_missing)},
                          {"logarithmic", p.logarithmic}});
  return {{"id", facts.id},
          {"rig", rig},
          {"kind", effects::name(facts.kind)},
          {"summary", facts.summary},
          {"equation", facts.equation},
          {"source", facts.source},
          {"needs", facts.needs},
          {"channel", channel_json(rig, facts.channel)},
          {"contains", facts.parents},
          {"free_per_trial", facts.free_per_trial},
          {"passive", facts.passive},
          {"parameters", std::move(parameters)}};
}

Json catalogue_json(std::string_view rig) {
  core::require(rig == "probing" || rig == "palpation", "a catalogue is of one of the two rigs");
  Json list = Json::array(), states = Json::array();
  if (rig == "probing")
    for (const auto& info : effects::probing_effects())
      list.push_back(effect_json(rig, info.facts));
  else
    for (const auto& info : effects::palpation_effects())
      list.push_back(effect_json(rig, info.facts));
  const effects::ExpressionRig& formulas = formulas_of(rig);
  for (const auto& state : formulas.states)
    states.push_back({{"name", state.name}, {"unit", state.unit}, {"meaning", state.meaning}});
  return {{"effects", std::move(list)},
          {"adds_to", formulas.adds_to},
          {"adds_unit", formulas.unit},
          {"states", std::move(states)}};
}

core::Result<Json> own_effect_json(const OwnEffect& own) {
  const bool palpation = own.definition.is_object() && own.definition.contains("rig") &&
                         own.definition["rig"] == "palpation";
  const std::string_view rig = palpation ? "palpation" : "probing";
  const auto expression =
      TRY(effects::Expression::from_json(own.definition, own.where, formulas_of(rig)));
  return effect_json(rig, expression.facts());
}

}  // namespace lab_io
}  // namespace tractus
