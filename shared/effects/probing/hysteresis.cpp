/// Friction that builds up over a displacement (Dahl): F = k z, ż = v − |v| z/δ.
#include <algorithm>
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Memory: z and the depth it belongs to. The rate does not matter, only the path: over a step that
/// does not turn back, z → s δ + (z − s δ) e^(−|Δx|/δ) with s = sgn Δx, exactly.
class Hysteresis final : public ProbeForce {
 public:
  explicit Hysteresis(std::span<const double> values)
      : stiffness_N_per_m_(values[0]), yield_m_(values[1]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory& memory) const noexcept override {
    double& bent_m = memory.own[0];
    const double way_m = tick.x_m - memory.depth_m;
    const double goal_m = std::copysign(yield_m_, way_m);
    bent_m = goal_m + (bent_m - goal_m) * std::exp(-std::abs(way_m) / yield_m_);
    memory.depth_m = tick.x_m;
    return stiffness_N_per_m_ * bent_m;
  }

 private:
  double stiffness_N_per_m_, yield_m_;
};

/// Displacements that fit into the recorded depths, for a friction of 1 N.
Starts hysteresis_starts(const ProbingStatistics& recordings) {
  Starts out;
  for (const double d : spread(1e-5, std::min(0.02, 0.5 * recordings.depth_range_m), 7))
    out.push_back({1.0 / d, std::clamp(d, 1e-6, 0.02)});
  return out;
}

}  // namespace

ProbingEffectInfo hysteresis() {
  return {{.id = "hysteresis",
           .label = "hysteresis",
           .kind = Kind::force,
           .summary = "Friction that builds up over a displacement, whatever the speed (Dahl)",
           .equation = "k z, dz/dt = v − |v| z/δ, z = 0 at the start",
           .source = "Olsson1998, the Dahl model",
           .experiment = "small reversals of 0.1, 0.3, 1 and 3 mm at one depth and one speed",
           .params = {{.name = "stiffness_N_per_m",
                       .meaning = "k, stiffness as the motion turns back; k δ is the friction",
                       .initial = 1e4,
                       .low = 0.0,
                       .high = 1e7},
                      {.name = "yield_displacement_m",
                       .meaning = "δ, displacement over which it builds up",
                       .initial = 1e-4,
                       .low = 1e-6,
                       .high = 0.02,
                       .off = kNoOff,
                       .logarithmic = true}},
           .parents = {"coulomb_friction"}},
          made<ProbeForce, Hysteresis>,
          hysteresis_starts};
}

}  // namespace effects::probing
}  // namespace tractus
