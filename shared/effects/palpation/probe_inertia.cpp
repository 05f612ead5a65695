/// The inertia of what hangs below the sensor: a mass on the handle's axis resists its
/// acceleration,
///
///     F = −m a,   τ = c ẑ × F   (in H),   a = a_H + α × c + ω × (ω × c)  of the mass
///
/// A point mass: its own moment of inertia is left out.
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace effects {
namespace {

class ProbeInertia final : public HandleWrench {
 public:
  ProbeInertia(double mass_kg, double centre_m) : mass_kg_(mass_kg), centre_m_(centre_m) {}

  void add(const HandleMotion& motion, math::Wrench& wrench_H) const noexcept override {
    const Vec3 c = motion.X_VH.q * Vec3(0.0, 0.0, centre_m_), &w = motion.omega_rad_s;
    const Vec3 a = motion.a_m_s2 + motion.alpha_rad_s2.cross(c) + w.cross(w.cross(c));
    const Vec3 F = -mass_kg_ * (motion.X_VH.q.conjugate() * a);
    wrench_H.force_N += F;
    wrench_H.torque_Nm += centre_m_ * Vec3::UnitZ().cross(F);
  }

 private:
  double mass_kg_, centre_m_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo probe_inertia() {
  return {.facts = {.id = "probe_inertia",
                    .kind = Kind::force,
                    .summary = "Inertia of the part of the probe below the sensor",
                    .equation = "F = −m a of a mass at centre_m along the handle's axis",
                    .source = "own; Newton's second law",
                    .params = {{.name = "mass_kg",
                                .meaning = "mass below the sensor",
                                .initial = 0.02,
                                .low = 0.0,
                                .high = 2.0},
                               {.name = "centre_m",
                                .meaning = "its centre from the sensor towards the tip",
                                .initial = 0.05,
                                .low = -0.2,
                                .high = 1.0,
                                .off = NAN}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ProbeInertia>(values[0], values[1]);
          }};
}
}  // namespace palpation

}  // namespace effects
