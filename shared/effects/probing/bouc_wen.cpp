/// Hysteresis whose loops may soften, harden or thin (Bouc–Wen): F = k z.
#include <algorithm>
#include <cmath>

#include "effects/memory_operator.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Memory: the operator's own, begun at the depth of the start.
class BoucWen final : public ProbeForce {
 public:
  explicit BoucWen(std::span<const double> values)
      : stiffness_N_per_m_(values[0]), yield_m_(values[1]), shape_(values[2]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory& memory) const noexcept override {
    FormulaMemory& kept = memory.formula;
    const MemoryStates states(kept.states.data(), kStatesOfMemory);
    if (!kept.started) begin(MemoryOperator::bouc_wen, {memory.depth_m, yield_m_, shape_}, states);
    kept.started = true;
    return stiffness_N_per_m_ * advance(MemoryOperator::bouc_wen, {tick.x_m, yield_m_, shape_},
                                        {tick.dt_s, tick.rest_m_s}, states);
  }

 private:
  double stiffness_N_per_m_, yield_m_, shape_;
};

/// Displacements that fit into the recorded depths, for loops that harden and that soften; a force
/// of 1 N.
Starts bouc_wen_starts(const ProbingStatistics& recordings) {
  Starts out;
  for (const double d : spread(2e-5, std::min(0.02, 0.5 * recordings.depth_range_m), 6))
    for (const double shape : {-1.3, -0.5, 0.7})
      out.push_back({1.0 / d, std::clamp(d, 1e-6, 0.02), shape});
  return out;
}

}  // namespace

ProbingEffectInfo bouc_wen() {
  return {
      {.id = "bouc_wen",
       .label = "Bouc–Wen hysteresis",
       .kind = Kind::force,
       .summary = "Hysteresis whose loops soften, harden or thin, whatever the speed (Bouc–Wen)",
       .equation = "k z, dz/dt = v − (|v| z + g v |z|)/δ, z = 0 at the start",
       .source = "Noel2016, with ν = 1",
       .experiment = "reversals of 0.1, 0.3, 1 and 3 mm at one depth, then strokes of 10 mm",
       .params = {{.name = "stiffness_N_per_m",
                   .meaning = "k, stiffness as z is 0",
                   .initial = 1e4,
                   .low = 0.0,
                   .high = 1e7},
                  {.name = "yield_displacement_m",
                   .meaning = "δ, displacement over which the loop bends",
                   .initial = 1e-4,
                   .low = 1e-6,
                   .high = 0.05,
                   .off = kNoOff,
                   .logarithmic = true},
                  {.name = "shape",
                   .meaning = "g: below −1 the loop hardens, 0 is Dahl's, above 1 it thins",
                   .initial = 0.5,
                   .low = -3.0,
                   .high = 10.0,
                   .off = kNoOff,
                   .unit = "1"}},
       .parents = {"coulomb_friction", "hysteresis"}},
      made<ProbeForce, BoucWen>,
      bouc_wen_starts};
}

}  // namespace effects::probing
}  // namespace tractus
