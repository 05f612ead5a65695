/// The forces of a recorded drilling, felt again.
#pragma once

#include <deque>
#include <optional>

#include "drilling/redrill.hpp"
#include "models/palpation_runtime.hpp"

namespace tractus::commands {

/// Follows a redrilling (drilling::redrill) with a field and a model: each sample's force is
/// computed again from its pose, on the bone with as many changes as it says it felt. Exact for a
/// model without effects; with effects, what the device said of velocities is not in the file.
class DrillForces {
 public:
  /// Errors: those of the field and of the model.
  static core::Result<std::unique_ptr<DrillForces>> make(const volume::Volume& bone,
                                                         const models::PalpationModel& model);
  void feel(const trial::Sample& sample);
  void follow(const drilling::Change& change, const volume::Volume& drilled);

  double largest_N() const { return largest_N_; }       ///< difference to what was recorded
  std::uint64_t compared() const { return compared_; }  ///< samples
  bool in_order() const { return in_order_; }           ///< no force felt a change before its cause

 private:
  explicit DrillForces(volume::ForceField field) : field_(std::move(field)) {}
  volume::ForceField field_;
  std::optional<models::PalpationRuntime> runtime_;
  laws::PalpationState state_;
  std::deque<volume::FieldPatch> waiting_;
  std::uint32_t applied_ = 0;
  std::uint64_t compared_ = 0;
  double largest_N_ = 0.0;
  bool in_order_ = true;
};

}  // namespace tractus::commands
