/// A model: a law with its numbers (and, later, its effects), as a value read from and written to a
/// model file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "laws/palpation_law.hpp"
#include "volume/force_field.hpp"

namespace models {

/// `tractus-model/1`, rig "palpation". A value: what replay, fit and the live loop all run.
struct PalpationModel {
  std::string name;
  std::string
      volume;  ///< path relative to the model file, or empty when the case or the set names it
  volume::TransferFunction transfer = volume::TransferFunction::bone();
  laws::PalpationParameters base;
  volume::FieldKind field = volume::FieldKind::paper;
  std::vector<std::string> fixed;  ///< JSON pointers of base parameters that a fit leaves alone

  /// @param where  leads every message, as "model.json: ". Errors: bad_input naming the field; a
  /// rig other than palpation and an effect that this build does not know are refused by name.
  static core::Result<PalpationModel> from_json(const core::Json& json, const std::string& where);
  static core::Result<PalpationModel> read(const std::filesystem::path& path);
  core::Json to_json() const;
};

/// A model made ready to run on a volume: owns the field, lends the law.
class PalpationRuntime {
 public:
  static core::Result<PalpationRuntime> make(const PalpationModel& model,
                                             const volume::Volume& volume,
                                             const core::Progress& progress = {});
  /// One tick: the pose as the device or the recording gives it; the model's pose offset is applied
  /// here. No allocation, lock or failure.
  laws::PalpationStep step(const math::Pose& X_VH, laws::PalpationState& state) const noexcept;
  /// Tip of the bent probe in V for that pose, offset applied, m.
  math::Vec3 tip_m(const math::Pose& X_VH, const math::Vec2& deflection_m) const noexcept;
  const laws::PalpationLaw& law() const noexcept { return law_; }
  const volume::ForceField& field() const noexcept { return *field_; }

 private:
  PalpationRuntime(std::unique_ptr<volume::ForceField> field, laws::PalpationLaw law)
      : field_(std::move(field)), law_(std::move(law)) {}
  std::unique_ptr<volume::ForceField> field_;
  laws::PalpationLaw law_;
};

}  // namespace models
