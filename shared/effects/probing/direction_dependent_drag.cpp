/// Drag that differs with the direction of motion: F = d |v| on top of the damping.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Half the difference of the dragging in and out; the layers' damping is their mean.
class DirectionDependentDrag final : public ProbeForce {
 public:
  explicit DirectionDependentDrag(std::span<const double> values)
      : half_difference_Ns_per_m_(values[0]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return half_difference_Ns_per_m_ * std::abs(tick.v_m_s);
  }

 private:
  double half_difference_Ns_per_m_;
};

}  // namespace

ProbingEffectInfo direction_dependent_drag() {
  return {{.id = "direction_dependent_drag",
           .label = "direction-dependent drag",
           .kind = Kind::force,
           .summary = "Viscous drag that is greater in one direction of motion than in the other",
           .equation = "d |v|",
           .source = "Janot2019, asymmetric friction",
           .experiment = "strokes in and out at the same 2, 10, 30 and 80 mm/s",
           .params = {{.name = "half_difference_Ns_per_m",
                       .meaning = "d, half of the drag on the way in less that on the way out",
                       .initial = 100.0,
                       .low = -1e5,
                       .high = 1e5}},
           .passive = false},  // alone it pushes on the way out; with the damping it does not
          made<ProbeForce, DirectionDependentDrag>};
}

}  // namespace effects::probing
}  // namespace tractus
