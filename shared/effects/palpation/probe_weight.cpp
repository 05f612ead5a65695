/// The weight of what hangs below the sensor: a mass on the handle's axis is pulled down,
///
///     F = m g d,   τ = c ẑ × F   (in H),   d down as the measurements state it, −z of V else
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace effects {
namespace {

constexpr double kGravity_m_s2 = 9.80665;

class ProbeWeight final : public HandleWrench {
 public:
  ProbeWeight(double mass_kg, double centre_m) : mass_kg_(mass_kg), centre_m_(centre_m) {}

  void add(const HandleMotion& motion, math::Wrench& wrench_H) const noexcept override {
    const Vec3 F = mass_kg_ * kGravity_m_s2 * (motion.X_VH.q.conjugate() * motion.down);
    wrench_H.force_N += F;
    wrench_H.torque_Nm += centre_m_ * Vec3::UnitZ().cross(F);
  }

 private:
  double mass_kg_, centre_m_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo probe_weight() {
  return {.facts = {.id = "probe_weight",
                    .kind = Kind::force,
                    .summary = "Weight of the part of the probe below the sensor",
                    .equation = "F = m g down, at centre_m along the handle's axis",
                    .source = "own; standard gravity 9.80665 m/s²",
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
            return std::make_unique<ProbeWeight>(values[0], values[1]);
          }};
}
}  // namespace palpation

}  // namespace effects
