/// The torque sensor is off by a constant: τ = T_0.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class RotaryBias final : public TorqueSensor {
 public:
  explicit RotaryBias(std::span<const double> values) : torque_Nm_(values[0]) {}
  void record(const ProbingMotion&, std::span<double> tz_Nm) const override {
    for (double& torque_Nm : tz_Nm) torque_Nm += torque_Nm_;
  }

 private:
  double torque_Nm_;
};

}  // namespace

ProbingEffectInfo rotary_bias() {
  return {{.id = "rotary_bias",
           .label = "rotary bias",
           .kind = Kind::measurement,
           .summary = "The torque sensor is off by a constant",
           .equation = "T_0",
           .source = "own",
           .experiment = "five seconds with nothing on the shaft, before and after",
           .params = {{.name = "torque_Nm",
                       .meaning = "T_0, what it shows too much",
                       .initial = 0.01,
                       .low = -10.0,
                       .high = 10.0}},
           .needs = {"theta_rad"},
           .channel = Channel::torque,
           .is_bias = true},
          made<TorqueSensor, RotaryBias>};
}

}  // namespace effects::probing
}  // namespace tractus
