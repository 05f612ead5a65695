/// What answers the handle's pose with a wrench: the model, as the loop sees it.
#pragma once

#include "models/model.hpp"

namespace loop {

class Contact {
 public:
  virtual ~Contact() = default;
  /// One tick, called by the loop's thread alone: no allocation, lock or failure.
  virtual laws::PalpationStep step(const math::Pose& X_VH) noexcept = 0;
};

/// The palpation model: the runtime is const, the bending of the last tick is here.
class PalpationContact final : public Contact {
 public:
  /// `runtime` must outlive this.
  explicit PalpationContact(const models::PalpationRuntime& runtime) : runtime_(runtime) {}
  laws::PalpationStep step(const math::Pose& X_VH) noexcept override {
    return runtime_.step(X_VH, state_);
  }

 private:
  const models::PalpationRuntime& runtime_;
  laws::PalpationState state_;
};

}  // namespace loop
