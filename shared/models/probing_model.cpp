#include "models/probing_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/try.hpp"
#include "effects/probing_effect.hpp"
#include "models/parts.hpp"

namespace tractus {
namespace models {
namespace {

using core::Fields;
using core::Json;
using core::Result;

constexpr double kExact_m = 1e-9, kRounding_m = 2e-6;  // of a border
constexpr std::size_t kMaxLayers = 4096;
/// The longest travel that the law takes: a model is checked against it, a rig against its own.
constexpr double kLongestTravel_m = 1.0;

/// The law checks ranges; here a number has only to be one.
double number(Fields& fields, const char* key) {
  constexpr double kAny = std::numeric_limits<double>::max();
  return fields.number(key, -kAny, kAny);
}

/// Borders that are rounded apart: a layer begins where the one before it ends, and keeps its own end.
void snap_layers(ProbingModel& model) {
  for (std::size_t k = 1; k < model.layers.size(); ++k) {
    const laws::Layer& before = model.layers[k - 1];
    laws::Layer& layer = model.layers[k];
    const double end_m = before.start_m + before.thickness_m, gap_m = layer.start_m - end_m;
    if (std::abs(gap_m) <= kExact_m || std::abs(gap_m) > kRounding_m ||
        layer.thickness_m + gap_m <= 0.0)
      continue;
    layer.start_m = end_m;
    layer.thickness_m += gap_m;
    model.remarks.push_back(
        fmt::format("layer {} begins where layer {} ends: {} of {:.2g} µm was taken as rounding",
                    k + 1, k, gap_m > 0.0 ? "a gap" : "an overlap", 1e6 * std::abs(gap_m)));
  }
}

OptionalError read_layers(Fields& base, ProbingModel& model) {
  const Json* list = base.member("layers");
  if (!list) return bad(base.where(), "layers", "is missing");
  if (!list->is_array() || list->size() > kMaxLayers)
    return bad(base.where(), "layers",
               fmt::format("an array of at most {} layers is expected", kMaxLayers));
  for (std::size_t k = 0; k < list->size(); ++k) {
    Fields fields((*list)[k], fmt::format("{}/layers/{}", base.where(), k));
    model.layers.push_back({number(fields, "start_m"), number(fields, "thickness_m"),
                            number(fields, "stiffness_N_per_m"), number(fields, "damping_Ns_per_m"),
                            number(fields, "equilibrium_m")});
    TRY(fields.done());
  }
  snap_layers(model);
  return std::nullopt;
}

OptionalError read_rotary(Fields& base, ProbingModel& model) {
  const Json* object = base.member("rotary", false);
  if (!object) return std::nullopt;
  model.states_rotary = true;
  Fields fields(*object, base.where() + "/rotary");
  laws::RotaryStage& r = model.rotary;
  r.viscous_Nms_per_rad = fields.number_or("viscous_Nms_per_rad", r.viscous_Nms_per_rad, 0.0, 10.0);
  r.detent_Nm = fields.number_or("detent_Nm", r.detent_Nm, 0.0, 10.0);
  r.detent_pitch_rad = fields.number_or("detent_pitch_rad", r.detent_pitch_rad, 1e-3, 7.0);
  TRY(fields.done());
  return std::nullopt;
}

OptionalError read_base(Fields& fields, ProbingModel& model) {
  const Json* object = fields.member("base");
  if (!object) return bad(fields.where(), "base", "is missing");
  Fields base(*object, fields.where() + "/base");
  if (!object->is_object()) return base.done().error();
  if (auto fault = read_layers(base, model)) return fault;
  if (auto fault = read_rotary(base, model)) return fault;
  TRY(base.done());
  if (auto law = model.law(kLongestTravel_m); !law)
    return core::Error{core::Errc::bad_input, base.where() + "/" + law.error().what};
  return std::nullopt;
}

}  // namespace

Result<laws::ProbingLaw> ProbingModel::law(double travel_m) const {
  return laws::ProbingLaw::make(
      {.layers = layers, .walls = {}, .rotary = rotary, .travel_m = travel_m});
}

Result<ProbingModel> ProbingModel::from_json(const Json& json, const std::string& where) {
  Fields fields(json, where);
  if (!json.is_object()) return fields.done().error();
  ProbingModel model;
  if (auto fault = read_identity(fields, "probing", model.name)) return *fault;
  if (auto fault = read_base(fields, model)) return *fault;
  ProbingModel whole = model;  // a number may be fixed that the file does not state
  whole.states_rotary = true;
  if (auto fault = read_fixed(fields, whole.to_json(), model.fixed)) return *fault;
  if (auto fault = read_effects(fields, effects::probing_facts, model.effects)) return *fault;
  TRY(fields.done());
  return model;
}

Result<ProbingModel> ProbingModel::read(const std::filesystem::path& path) {
  auto json = TRY(core::read_json(path));
  return from_json(json, path.string() + ": ");
}

Json ProbingModel::to_json() const {
  Json list = Json::array();
  for (const laws::Layer& layer : layers)
    list.push_back({{"start_m", layer.start_m},
                    {"thickness_m", layer.thickness_m},
                    {"stiffness_N_per_m", layer.stiffness_N_per_m},
                    {"damping_Ns_per_m", layer.damping_Ns_per_m},
                    {"equilibrium_m", layer.equilibrium_m}});
  Json base{{"layers", std::move(list)}};
  if (states_rotary || rotary != laws::RotaryStage{})
    base["rotary"] = {{"viscous_Nms_per_rad", rotary.viscous_Nms_per_rad},
                      {"detent_Nm", rotary.detent_Nm},
                      {"detent_pitch_rad", rotary.detent_pitch_rad}};
  return {{"format", kModelFormat}, {"rig", "probing"},
          {"name", name},           {"base", std::move(base)},
          {"fixed", fixed},         {"effects", effects_to_json(effects, effects::probing_facts)}};
}

}  // namespace models
}  // namespace tractus
