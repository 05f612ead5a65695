/// A model: a law with its numbers and its effects, as a value read from and written to a model
/// file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"
#include "laws/palpation_law.hpp"
#include "volume/force_field.hpp"
#include "volume/transfer_function.hpp"

namespace tractus::models {

/// `tractus-model/1`, rig "palpation". A value: what replay, fit and the live loop all run.
struct PalpationModel {
  std::string name;
  std::string
      volume;  ///< path relative to the model file, or empty when the case or the set names it
  volume::TransferFunction transfer = volume::TransferFunction::bone();
  laws::PalpationParameters base;
  volume::FieldKind field = volume::FieldKind::paper;
  std::vector<std::string> fixed;  ///< JSON pointers of base parameters that a fit leaves alone
  std::vector<effects::EffectInstance> effects = {};  ///< in the file's order

  /// @param where  leads every message, as "model.json: ". Errors: bad_input naming the field; a
  /// rig other than palpation and an effect that this build does not know are refused by name.
  static core::Result<PalpationModel> from_json(const core::Json& json, const std::string& where);
  static core::Result<PalpationModel> read(const std::filesystem::path& path);
  core::Json to_json() const;
};

}  // namespace tractus::models
