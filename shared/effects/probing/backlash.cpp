/// Play between probe and bone: the bone sees the depth through a dead zone of full width.
#include <algorithm>
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// State: the depth seen. It stays while the probe moves within half the gap of it and is drawn
/// along else. The play is centred at the first moment. Layers and springs see that depth. Whether
/// the damping goes on with the probe's own speed (it is the stage's) or with that of the depth
/// seen (it is the bone's) depends on the rig: `damping_share`.
class Backlash final : public ProbingEffect {
 public:
  explicit Backlash(std::span<const double> values)
      : half_m_(0.5 * values[0]), kept_share_(1.0 - values[1]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::depth; }
  std::size_t states() const noexcept override { return 1; }
  void start(const ProbingTick& first, double* state) const noexcept override {
    state[0] = first.x_m;
  }
  void see(ProbingTick& tick, const double* state) const noexcept override {
    const bool inside = std::abs(tick.x_m - state[0]) < half_m_;
    tick.x_m = depth_m(tick, state);
    if (inside) tick.v_m_s *= kept_share_;
  }
  void commit(const ProbingTick& tick, double* state) const noexcept override {
    state[0] = depth_m(tick, state);
  }

 private:
  double depth_m(const ProbingTick& tick, const double* state) const noexcept {
    return std::clamp(state[0], tick.x_m - half_m_, tick.x_m + half_m_);
  }
  double half_m_, kept_share_;
};

}  // namespace

ProbingEffectInfo backlash() {
  return {{.id = "backlash",
           .kind = Kind::structure,
           .summary = "Play: the bone sees the depth through a dead zone",
           .equation = "K (x̃ − x0) + D v, x̃ = play(x, gap), |x − x̃| ≤ gap/2, centred at the start; "
                       "D (1 − share) v within the play",
           .source = "own",
           .params = {{.name = "gap_m",
                       .meaning = "full width of the dead zone",
                       .initial = 3e-4,
                       .low = 0.0,
                       .high = 5e-3},
                      {.name = "damping_share",
                       .meaning = "share of the damping that the play interrupts too: 0 or 1, less "
                                  "or more only as a fit's error",
                       .initial = 0.0,
                       .low = -0.25,
                       .high = 1.25,
                       .off = kNoOff,
                       .if_missing = 0.0}},
           .passive = false},  // the spring returns at a greater depth than it was loaded at
          made<Backlash>};
}

}  // namespace effects::probing
}  // namespace tractus
