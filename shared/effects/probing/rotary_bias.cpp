/// The torque sensor is off by a constant: τ = T_0.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class RotaryBias final : public ProbingEffect {
 public:
  explicit RotaryBias(std::span<const double> values) : torque_Nm_(values[0]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::recording; }
  void record_torque(const ProbingMotion&, std::span<double> tz_Nm) const override {
    for (double& torque_Nm : tz_Nm) torque_Nm += torque_Nm_;
  }

 private:
  double torque_Nm_;
};

}  // namespace

ProbingEffectInfo rotary_bias() {
  return {{.id = "rotary_bias",
           .kind = Kind::measurement,
           .summary = "The torque sensor is off by a constant",
           .equation = "T_0",
           .source = "own",
           .params = {{.name = "torque_Nm",
                       .meaning = "T_0, what it shows too much",
                       .initial = 0.01,
                       .low = -10.0,
                       .high = 10.0}},
           .needs = {"theta_rad"}},
          made<RotaryBias>};
}

}  // namespace effects::probing
}  // namespace tractus
