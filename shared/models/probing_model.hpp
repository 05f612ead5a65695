/// The model of the probing rig, as a value read from and written to a model file.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"
#include "laws/probing_law.hpp"
#include "models/model.hpp"

namespace tractus::models {

/// `tractus-model/1`, rig "probing": layers by depth (one, many or none) and the rotary stage.
/// Walls and travel are not the model's but the scenario's and the rig's.
struct ProbingModel {
  std::string name;
  std::vector<laws::Layer> layers;  ///< by depth, without overlap
  laws::RotaryStage rotary;
  std::vector<std::string> fixed;  ///< JSON pointers of base parameters that a fit leaves alone
  std::vector<effects::EffectInstance> effects = {};  ///< in the file's order
  std::vector<std::string> remarks = {};              ///< what reading mended, for people
  bool states_rotary =
      false;  ///< the file has numbers of the rotary stage, else they are the rig's usual ones

  /// @param where  leads every message, as "model.json: ". Errors: bad_input naming the field, the
  /// law's own refusals among them; another rig and every effect are refused by name.
  static core::Result<ProbingModel> from_json(const core::Json& json, const std::string& where);
  static core::Result<ProbingModel> read(const std::filesystem::path& path);
  core::Json to_json() const;

  /// Made ready to run over a travel. Errors: out_of_range naming the layer that does not fit.
  core::Result<laws::ProbingLaw> law(double travel_m) const;
};

/// A model of either rig; the file's "rig" says which.
using Model = std::variant<PalpationModel, ProbingModel>;
core::Result<Model> model_from_json(const core::Json& json, const std::string& where);
core::Result<Model> read_model(const std::filesystem::path& path);

}  // namespace tractus::models
