/// A force that comes back with the depth, as of a lead screw or of a motor's poles:
/// F = A sin(2π x/p + φ).
#include <cmath>
#include <numbers>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class ForceRipple final : public ProbingEffect {
 public:
  explicit ForceRipple(std::span<const double> values)
      : amplitude_N_(values[0]),
        wave_rad_per_m_(2.0 * std::numbers::pi / values[1]),
        phase_rad_(values[2]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::force; }
  double force_N(const ProbingTick& tick, double, const double*) const noexcept override {
    return amplitude_N_ * std::sin(wave_rad_per_m_ * tick.x_m + phase_rad_);
  }

 private:
  double amplitude_N_, wave_rad_per_m_, phase_rad_;
};

}  // namespace

ProbingEffectInfo force_ripple() {
  return {{.id = "force_ripple",
           .kind = Kind::force,
           .summary = "A force that comes back with the depth, as of a lead screw",
           .equation = "A sin(2π x/p + φ)",
           .source = "own",
           .params =
               {{.name = "amplitude_N", .meaning = "A", .initial = 0.5, .low = 0.0, .high = 100.0},
                {.name = "period_m",
                 .meaning = "p, depth after which it comes back",
                 .initial = 2e-3,
                 .low = 5e-5,
                 .high = 0.1,
                 .off = kNoOff,
                 .logarithmic = true},
                {.name = "phase_rad",
                 .meaning = "φ, phase at depth 0",
                 .initial = 0.0,
                 .low = -2.0 * std::numbers::pi,
                 .high = 2.0 * std::numbers::pi,
                 .off = kNoOff}}},
          made<ForceRipple>};
}

}  // namespace effects::probing
}  // namespace tractus
