/// Dry friction of constant size: F = F_c sgn v.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class CoulombFriction final : public ProbeForce {
 public:
  explicit CoulombFriction(std::span<const double> values) : friction_N_(values[0]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return friction_N_ * direction(tick.v_m_s, tick.rest_m_s);
  }

 private:
  double friction_N_;
};

}  // namespace

ProbingEffectInfo coulomb_friction() {
  return {
      {.id = "coulomb_friction",
       .label = "Coulomb friction",
       .kind = Kind::force,
       .summary = "Dry friction of constant size against the motion",
       .equation = "F_c sgn v",
       .source = "Olsson1998, Coulomb friction",
       .experiment =
           "strokes in and out over the same depth at 1, 3 and 10 mm/s, with ten reversals or more",
       .params = {{.name = "friction_N",
                   .meaning = "F_c, size of the friction",
                   .initial = 1.0,
                   .low = 0.0,
                   .high = 200.0}},
       .is_dry = true},
      made<ProbeForce, CoulombFriction>};
}

}  // namespace effects::probing
}  // namespace tractus
