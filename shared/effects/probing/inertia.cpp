/// Mass that moves with the probe: F = m a.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class Inertia final : public ProbeForce {
 public:
  explicit Inertia(std::span<const double> values) : mass_kg_(values[0]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return mass_kg_ * tick.a_m_s2;
  }

 private:
  double mass_kg_;
};

}  // namespace

ProbingEffectInfo inertia() {
  return {{.id = "inertia",
           .label = "inertia",
           .kind = Kind::force,
           .summary = "Mass that moves with the probe",
           .equation = "m a",
           .source = "Probing, eq. (1), where M = 0",
           .experiment =
               "fast strokes of 5 mm at 2 to 4 per second in one layer, and slow ones at 1 mm/s",
           .params = {{.name = "mass_kg",
                       .meaning = "m, moving mass, the drive's reflected one included",
                       .initial = 1.0,
                       .low = 0.0,
                       .high = 100.0}}},
          made<ProbeForce, Inertia>};
}

}  // namespace effects::probing
}  // namespace tractus
