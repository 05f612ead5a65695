/// A spring that yields with time (Maxwell branch): F = k q, q̇ = v − q/τ.
#include <algorithm>
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Memory: q, the depth it belongs to, and the last step with its decay (a step's length seldom
/// changes).
class ViscoelasticRelaxation final : public ProbeForce {
 public:
  explicit ViscoelasticRelaxation(std::span<const double> values)
      : stiffness_N_per_m_(values[0]), time_constant_s_(values[1]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory& memory) const noexcept override {
    auto& [stretch_m, step_s, decay] = memory.own;
    if (tick.dt_s != step_s) {
      step_s = tick.dt_s;
      decay = std::exp(-step_s / time_constant_s_);
    }
    if (tick.dt_s > 0.0) stretch_m = stretched_m(tick, memory.depth_m, stretch_m, decay);
    memory.depth_m = tick.x_m;
    return stiffness_N_per_m_ * stretch_m;
  }

 private:
  /// Exact for a speed that is constant over the step: q e^(−dt/τ) + v τ (1 − e^(−dt/τ)); of second
  /// order else.
  double stretched_m(const ProbingTick& tick, double from_m, double stretch_m,
                     double decay) const noexcept {
    const double mean_m_s = (tick.x_m - from_m) / tick.dt_s;
    return stretch_m * decay + mean_m_s * time_constant_s_ * (1.0 - decay);
  }
  double stiffness_N_per_m_, time_constant_s_;
};

/// Times that fit into the longest trial.
Starts viscoelastic_relaxation_starts(const ProbingStatistics& recordings) {
  Starts out;
  for (const double tau_s : spread(0.02, std::min(90.0, recordings.longest_s), 7))
    out.push_back({500.0, tau_s});
  return out;
}

}  // namespace

ProbingEffectInfo viscoelastic_relaxation() {
  return {{.id = "viscoelastic_relaxation",
           .label = "viscoelastic relaxation",
           .kind = Kind::structure,
           .summary = "A part of the stiffness that relaxes while the probe rests (Maxwell branch)",
           .equation = "k q, dq/dt = v − q/τ, q = 0 at the start",
           .source = "own",
           .experiment = "a staircase: fast steps of 5 mm, each followed by a hold of 3 to 10 s",
           .params = {{.name = "stiffness_N_per_m",
                       .meaning = "k, stiffness of the branch against fast motion",
                       .initial = 500.0,
                       .low = 0.0,
                       .high = 2e5},
                      {.name = "time_constant_s",
                       .meaning = "τ, time in which its force falls to 1/e",
                       .initial = 0.5,
                       .low = 5e-3,
                       .high = 100.0,
                       .off = kNoOff,
                       .logarithmic = true}}},
          made<ProbeForce, ViscoelasticRelaxation>,
          viscoelastic_relaxation_starts};
}

}  // namespace effects::probing
}  // namespace tractus
