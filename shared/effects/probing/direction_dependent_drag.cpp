/// Drag that differs with the direction of motion, where there is no bone too: F = d |v| + m v.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Half the difference of the drag on the way in and out, and its mean, to which a layer's damping adds.
class DirectionDependentDrag final : public ProbeForce {
 public:
  explicit DirectionDependentDrag(std::span<const double> values)
      : half_difference_Ns_per_m_(values[0]), mean_Ns_per_m_(values[1]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return half_difference_Ns_per_m_ * std::abs(tick.v_m_s) + mean_Ns_per_m_ * tick.v_m_s;
  }

 private:
  double half_difference_Ns_per_m_, mean_Ns_per_m_;
};

}  // namespace

ProbingEffectInfo direction_dependent_drag() {
  return {
      {.id = "direction_dependent_drag",
       .label = "direction-dependent drag",
       .kind = Kind::force,
       .summary = "Viscous drag that is greater in one direction of motion than in the other",
       .equation = "d |v| + m v",
       .source = "Janot2019, asymmetric friction",
       .experiment = "strokes in and out at the same 2, 10, 30 and 80 mm/s",
       .params = {{.name = "half_difference_Ns_per_m",
                   .meaning = "d, half of the drag on the way in less that on the way out",
                   .initial = 100.0,
                   .low = -1e5,
                   .high = 1e5},
                  // Within bone a damping is a mean drag already; where there is none it is not.
                  {.name = "mean_Ns_per_m",
                   .meaning =
                       "m, mean of the drag on the way in and out, beside the layers' damping",
                   .initial = 10.0,
                   .low = -1e5,
                   .high = 1e5,
                   .if_missing = 0.0}},
       .passive = false,  // alone it pushes on the way out; with the damping it does not
       // Else it is a drag alike on both ways.
       .admissible =
           [](std::span<const double> values) {
             return std::abs(values[0]) >= 0.1 * std::abs(values[1]);
           }},
      made<ProbeForce, DirectionDependentDrag>};
}

}  // namespace effects::probing
}  // namespace tractus
