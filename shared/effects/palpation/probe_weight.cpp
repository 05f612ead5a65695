/// The weight of what hangs below the sensor: a mass on the handle's axis is pulled down,
///
///     F = m g d,   τ = c ẑ × F   (in H),   d down as the measurements state it, −z of V else
#include "effects/palpation/mass_on_axis.hpp"

namespace tractus {
namespace effects {
namespace {

constexpr double kGravity_m_s2 = 9.80665;

class ProbeWeight final : public HandleWrench {
 public:
  explicit ProbeWeight(MassOnAxis mass) : mass_(mass) {}

  void add(const HandleMotion& motion, math::Wrench& wrench_H) const noexcept override {
    mass_.pull(mass_.mass_kg * kGravity_m_s2 * (motion.X_VH.q.conjugate() * motion.down), wrench_H);
  }

 private:
  MassOnAxis mass_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo probe_weight() {
  return {.facts = {.id = "probe_weight",
                    .label = "probe weight",
                    .kind = Kind::force,
                    .summary = "Weight of the part of the probe below the sensor",
                    .equation = "F = m g down, at centre_m along the handle's axis",
                    .source = "own; standard gravity 9.80665 m/s²",
                    .experiment = "slow turns in free air about all three axes",
                    .params = MassOnAxis::params(),
                    .starts = MassOnAxis::starts()},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ProbeWeight>(MassOnAxis::of(values));
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
