/// Mass that moves with the probe: F = m a.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class Inertia final : public ProbingEffect {
 public:
  explicit Inertia(std::span<const double> values) : mass_kg_(values[0]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::force; }
  double force_N(const ProbingTick& tick, double, const double*) const noexcept override {
    return mass_kg_ * tick.a_m_s2;
  }

 private:
  double mass_kg_;
};

}  // namespace

ProbingEffectInfo inertia() {
  return {{.id = "inertia",
           .kind = Kind::force,
           .summary = "Mass that moves with the probe",
           .equation = "m a",
           .source = "Probing, eq. (1), where M = 0",
           .params = {{.name = "mass_kg",
                       .meaning = "m, moving mass, the drive's reflected one included",
                       .initial = 1.0,
                       .low = 0.0,
                       .high = 100.0}}},
          made<Inertia>};
}

}  // namespace effects::probing
}  // namespace tractus
