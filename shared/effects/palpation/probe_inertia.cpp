/// The inertia of what hangs below the sensor: a mass on the handle's axis resists its
/// acceleration,
///
///     F = −m a,   τ = c ẑ × F   (in H),   a = a_H + α × c + ω × (ω × c)  of the mass
///
/// A point mass: its own moment of inertia is left out.
#include "effects/palpation/mass_on_axis.hpp"

namespace tractus {
namespace effects {
namespace {

class ProbeInertia final : public HandleWrench {
 public:
  explicit ProbeInertia(MassOnAxis mass) : mass_(mass) {}

  void add(const HandleMotion& motion, math::Wrench& wrench_H) const noexcept override {
    const Vec3 c = motion.X_VH.q * Vec3(0.0, 0.0, mass_.centre_m), &w = motion.omega_rad_s;
    const Vec3 a = motion.a_m_s2 + motion.alpha_rad_s2.cross(c) + w.cross(w.cross(c));
    mass_.pull(-mass_.mass_kg * (motion.X_VH.q.conjugate() * a), wrench_H);
  }

 private:
  MassOnAxis mass_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo probe_inertia() {
  return {.facts = {.id = "probe_inertia",
                    .label = "probe inertia",
                    .kind = Kind::force,
                    .summary = "Inertia of the part of the probe below the sensor",
                    .equation = "F = −m a of a mass at centre_m along the handle's axis",
                    .source = "own; Newton's second law",
                    .experiment = "quick shakes in free air along and across the probe",
                    .params = MassOnAxis::params(),
                    .starts = MassOnAxis::starts()},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ProbeInertia>(MassOnAxis::of(values));
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
