/// Play between probe and bone: the bone sees the depth through a dead zone of full width.
#include <algorithm>
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// Memory: the depth seen. It stays while the probe moves within half the gap of it and is drawn
/// along else. The play is centred at the first moment. Layers and springs see that depth. Whether
/// the damping goes on with the probe's own speed (it is the stage's) or with that of the depth
/// seen (it is the bone's) depends on the rig: `damping_share`.
class Backlash final : public BoneDepth {
 public:
  explicit Backlash(std::span<const double> values)
      : half_m_(0.5 * values[0]), kept_share_(1.0 - values[1]) {}
  void see(ProbingTick& tick, ProbingMemory& memory) const noexcept override {
    const bool inside = std::abs(tick.x_m - memory.depth_m) < half_m_;
    memory.depth_m = std::clamp(memory.depth_m, tick.x_m - half_m_, tick.x_m + half_m_);
    tick.x_m = memory.depth_m;
    if (inside) tick.v_m_s *= kept_share_;
  }

 private:
  double half_m_, kept_share_;
};

}  // namespace

ProbingEffectInfo backlash() {
  return {{.id = "backlash",
           .label = "backlash",
           .kind = Kind::structure,
           .summary = "Play: the bone sees the depth through a dead zone",
           .equation = "K (x̃ − x0) + D v, x̃ = play(x, gap), |x − x̃| ≤ gap/2, centred at the start; "
                       "D (1 − share) v within the play",
           .source = "own",
           .experiment = "small reversals of 0.1 to 2 mm in two layers of different stiffness",
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
                       .if_missing = 0.0,
                       .unit = "1"}},
           .passive = false,  // the spring returns at a greater depth than it was loaded at
           // A small play and a great one; it interrupts the damping, or it does not.
           .starts = {{1e-4, 0.0}, {1e-4, 1.0}, {1e-3, 0.0}, {1e-3, 1.0}}},
          made<BoneDepth, Backlash>};
}

}  // namespace effects::probing
}  // namespace tractus
