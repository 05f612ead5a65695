#include "app/drill_forces.hpp"

#include <algorithm>

#include "core/try.hpp"

namespace tractus::commands {
using math::Vec3;

core::Result<std::unique_ptr<DrillForces>> DrillForces::make(const volume::Volume& bone,
                                                             const models::PalpationModel& model) {
  auto field = TRY(volume::ForceField::make(bone, model.transfer, model.field));
  std::unique_ptr<DrillForces> made(new DrillForces(std::move(field)));
  auto runtime = TRY(models::PalpationRuntime::make(model, made->field_));
  made->runtime_.emplace(std::move(runtime));
  return made;
}

void DrillForces::feel(const trial::Sample& sample) {
  for (; applied_ < sample.patches && in_order_; ++applied_) {
    in_order_ = !waiting_.empty();
    if (!in_order_) return;
    field_.apply(waiting_.front());
    waiting_.pop_front();
  }
  const Vec3 felt(sample.force_N[0], sample.force_N[1], sample.force_N[2]);
  if ((sample.flags & trial::kStale) && felt.isZero(0.0)) return;  // the model was not asked
  const Vec3 again = runtime_->step(sample.pose(), state_).wrench_H.force_N;
  largest_N_ = std::max(largest_N_, (again.cast<float>().cast<double>() - felt).norm());
  ++compared_;
}

void DrillForces::follow(const drilling::Change& change, const volume::Volume& drilled) {
  waiting_.emplace_back(drilling::kMostPatchFloats);
  field_.compute(drilled, change.box, waiting_.back());
}

}  // namespace tractus::commands
