#include "models/model.hpp"

namespace models {
namespace {
math::Pose shifted(math::Pose X_VH, const math::Vec3& by_V_m) noexcept {
  X_VH.p += by_V_m;
  return X_VH;
}
}  // namespace

core::Result<PalpationRuntime> PalpationRuntime::make(const PalpationModel& model,
                                                      const volume::Volume& volume,
                                                      const core::Progress& progress) {
  auto made = volume::ForceField::make(volume, model.transfer, model.field, progress);
  if (!made) return made.error();
  auto field = std::make_unique<volume::ForceField>(std::move(*made));
  auto law = laws::PalpationLaw::make(model.base, *field);
  if (!law) return law.error();
  return PalpationRuntime(std::move(field), std::move(*law));
}

laws::PalpationStep PalpationRuntime::step(const math::Pose& X_VH,
                                           laws::PalpationState& state) const noexcept {
  return law_.step(shifted(X_VH, law_.parameters().pose_offset_m), state);
}

math::Vec3 PalpationRuntime::tip_m(const math::Pose& X_VH,
                                   const math::Vec2& deflection_m) const noexcept {
  return law_.tip_m(shifted(X_VH, law_.parameters().pose_offset_m), deflection_m);
}

}  // namespace models
