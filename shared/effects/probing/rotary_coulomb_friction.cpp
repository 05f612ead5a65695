/// Dry friction of the turning stage, of constant size: τ = T_c sgn ω.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class RotaryCoulombFriction final : public ProbeTorque {
 public:
  explicit RotaryCoulombFriction(std::span<const double> values) : torque_Nm_(values[0]) {}
  double torque_Nm(const ProbingTick& tick) const noexcept override {
    return torque_Nm_ * direction(tick.omega_rad_s, tick.rest_rad_s);
  }

 private:
  double torque_Nm_;
};

}  // namespace

ProbingEffectInfo rotary_coulomb_friction() {
  return {{.id = "rotary_coulomb_friction",
           .label = "rotary Coulomb friction",
           .kind = Kind::force,
           .summary = "Dry friction of constant size against the turning",
           .equation = "T_c sgn ω",
           .source = "Olsson1998, Coulomb friction",
           .experiment =
               "turning to and fro over the same angle at three speeds, with ten reversals or more",
           .params = {{.name = "torque_Nm",
                       .meaning = "T_c, size of the friction",
                       .initial = 0.01,
                       .low = 0.0,
                       .high = 10.0}},
           .needs = {"omega_rad_s"},
           .channel = Channel::torque,
           .is_dry = true},
          made<ProbeTorque, RotaryCoulombFriction>};
}

}  // namespace effects::probing
}  // namespace tractus
