/// The turning stage is held by a spring, as by cables that reach on: τ = k θ.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class RotaryStiffness final : public ProbeTorque {
 public:
  explicit RotaryStiffness(std::span<const double> values) : stiffness_Nm_per_rad_(values[0]) {}
  double torque_Nm(const ProbingTick& tick) const noexcept override {
    return stiffness_Nm_per_rad_ * tick.theta_rad;
  }

 private:
  double stiffness_Nm_per_rad_;
};

}  // namespace

ProbingEffectInfo rotary_stiffness() {
  return {{.id = "rotary_stiffness",
           .label = "rotary stiffness",
           .kind = Kind::force,
           .summary = "A spring about the axis, at rest where the angle is 0",
           .equation = "k θ",
           .source = "own",
           .experiment = "slow turns to and fro over 10°, 30° and 60°, with holds at each end",
           .params = {{.name = "stiffness_Nm_per_rad",
                       .meaning = "k, torque per angle",
                       .initial = 0.02,
                       .low = 0.0,
                       .high = 100.0}},
           .needs = {"theta_rad"},
           .channel = Channel::torque},
          made<ProbeTorque, RotaryStiffness>};
}

}  // namespace effects::probing
}  // namespace tractus
