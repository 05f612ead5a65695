/// Play between probe and bone: the bone sees the depth through a dead zone of full width.
#include <algorithm>

#include "effects/probing_effect.hpp"

namespace effects::probing {
namespace {

/// State: the depth seen. It stays while the probe moves within half the gap of it and is drawn
/// along else. The play is centred at the first moment. Layers and springs see that depth; the
/// damping goes on with the probe's own speed.
class Backlash final : public ProbingEffect {
 public:
  explicit Backlash(std::span<const double> values) : half_m_(0.5 * values[0]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::depth; }
  std::size_t states() const noexcept override { return 1; }
  void start(const ProbingTick& first, double* state) const noexcept override {
    state[0] = first.x_m;
  }
  double depth_m(const ProbingTick& tick, const double* state) const noexcept override {
    return std::clamp(state[0], tick.x_m - half_m_, tick.x_m + half_m_);
  }
  void commit(const ProbingTick& tick, double* state) const noexcept override {
    state[0] = depth_m(tick, state);
  }

 private:
  double half_m_;
};

}  // namespace

ProbingEffectInfo backlash() {
  return {{.id = "backlash",
           .kind = Kind::structure,
           .summary = "Play: the bone sees the depth through a dead zone",
           .equation = "K (x̃ − x0) + D v, x̃ = play(x, gap), |x − x̃| ≤ gap/2, centred at the start",
           .source = "own",
           .params = {{.name = "gap_m",
                       .meaning = "full width of the dead zone",
                       .initial = 3e-4,
                       .low = 0.0,
                       .high = 5e-3}},
           .passive = false},  // the spring returns at a greater depth than it was loaded at
          made<Backlash>};
}

}  // namespace effects::probing
