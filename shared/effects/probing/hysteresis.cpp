/// Friction that builds up over a displacement (Dahl): F = k z, ż = v − |v| z/δ.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// State: z and the depth it belongs to. The rate does not matter, only the path: over a step that
/// does not turn back, z → s δ + (z − s δ) e^(−|Δx|/δ) with s = sgn Δx, exactly.
class Hysteresis final : public ProbingEffect {
 public:
  explicit Hysteresis(std::span<const double> values)
      : stiffness_N_per_m_(values[0]), yield_m_(values[1]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::force; }
  std::size_t states() const noexcept override { return 2; }
  void start(const ProbingTick& first, double* state) const noexcept override {
    state[kBent_m] = 0.0;
    state[kDepth_m] = first.x_m;
  }
  double force_N(const ProbingTick& tick, double, const double* state) const noexcept override {
    return stiffness_N_per_m_ * bent_m(tick, state);
  }
  void commit(const ProbingTick& tick, double* state) const noexcept override {
    replay_N(tick, 0.0, state);
  }
  double replay_N(const ProbingTick& tick, double, double* state) const noexcept override {
    state[kBent_m] = bent_m(tick, state);
    state[kDepth_m] = tick.x_m;
    return stiffness_N_per_m_ * state[kBent_m];
  }

 private:
  enum { kBent_m, kDepth_m };
  double bent_m(const ProbingTick& tick, const double* state) const noexcept {
    const double way_m = tick.x_m - state[kDepth_m];
    const double goal_m = std::copysign(yield_m_, way_m);
    return goal_m + (state[kBent_m] - goal_m) * std::exp(-std::abs(way_m) / yield_m_);
  }
  double stiffness_N_per_m_, yield_m_;
};

}  // namespace

ProbingEffectInfo hysteresis() {
  return {{.id = "hysteresis",
           .kind = Kind::force,
           .summary = "Friction that builds up over a displacement, whatever the speed (Dahl)",
           .equation = "k z, dz/dt = v − |v| z/δ, z = 0 at the start",
           .source = "Olsson1998, the Dahl model",
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
          made<Hysteresis>};
}

}  // namespace effects::probing
}  // namespace tractus
