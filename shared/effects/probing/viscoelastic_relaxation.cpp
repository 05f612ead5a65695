/// A spring that yields with time (Maxwell branch): F = k q, q̇ = v − q/τ.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// State: q, the depth it belongs to, and the last step with its decay (a step's length seldom
/// changes).
class ViscoelasticRelaxation final : public ProbingEffect {
 public:
  explicit ViscoelasticRelaxation(std::span<const double> values)
      : stiffness_N_per_m_(values[0]), time_constant_s_(values[1]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::force; }
  std::size_t states() const noexcept override { return 4; }
  void start(const ProbingTick& first, double* state) const noexcept override {
    state[kStretch_m] = 0.0;
    state[kDepth_m] = first.x_m;
    state[kStep_s] = 0.0;
    state[kDecay] = 1.0;
  }
  double force_N(const ProbingTick& tick, double, const double* state) const noexcept override {
    const double decay = tick.dt_s == state[kStep_s] ? state[kDecay] : decay_over(tick.dt_s);
    return stiffness_N_per_m_ * stretch_m(tick, decay, state);
  }
  void commit(const ProbingTick& tick, double* state) const noexcept override {
    replay_N(tick, 0.0, state);
  }
  double replay_N(const ProbingTick& tick, double, double* state) const noexcept override {
    if (tick.dt_s != state[kStep_s]) {
      state[kStep_s] = tick.dt_s;
      state[kDecay] = decay_over(tick.dt_s);
    }
    state[kStretch_m] = stretch_m(tick, state[kDecay], state);
    state[kDepth_m] = tick.x_m;
    return stiffness_N_per_m_ * state[kStretch_m];
  }

 private:
  enum { kStretch_m, kDepth_m, kStep_s, kDecay };
  double decay_over(double dt_s) const noexcept { return std::exp(-dt_s / time_constant_s_); }
  /// Exact for a speed that is constant over the step: q e^(−dt/τ) + v τ (1 − e^(−dt/τ)); of second
  /// order else.
  double stretch_m(const ProbingTick& tick, double decay, const double* state) const noexcept {
    if (tick.dt_s <= 0.0) return state[kStretch_m];
    const double mean_m_s = (tick.x_m - state[kDepth_m]) / tick.dt_s;
    return state[kStretch_m] * decay + mean_m_s * time_constant_s_ * (1.0 - decay);
  }
  double stiffness_N_per_m_, time_constant_s_;
};

}  // namespace

ProbingEffectInfo viscoelastic_relaxation() {
  return {{.id = "viscoelastic_relaxation",
           .kind = Kind::structure,
           .summary = "A part of the stiffness that relaxes while the probe rests (Maxwell branch)",
           .equation = "k q, dq/dt = v − q/τ, q = 0 at the start",
           .source = "own",
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
          made<ViscoelasticRelaxation>};
}

}  // namespace effects::probing
}  // namespace tractus
