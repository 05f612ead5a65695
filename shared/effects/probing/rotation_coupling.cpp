/// Turning the probe eases its way: the bone's resistance is divided by 1 + κ |ω|.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class RotationCoupling final : public BoneScale {
 public:
  explicit RotationCoupling(std::span<const double> values) : coefficient_s_per_rad_(values[0]) {}
  double scale(const ProbingTick& tick) const noexcept override {
    return 1.0 / (1.0 + coefficient_s_per_rad_ * std::abs(tick.omega_rad_s));
  }

 private:
  double coefficient_s_per_rad_;
};

}  // namespace

ProbingEffectInfo rotation_coupling() {
  return {{.id = "rotation_coupling",
           .label = "rotation coupling",
           .kind = Kind::structure,
           .summary = "Turning the probe eases its way into the bone",
           .equation = "(K (x − x0) + D v) / (1 + κ |ω|)",
           .source = "own",
           .experiment = "the same stroke while turning slowly, fast and with changing speed",
           .params = {{.name = "coefficient_s_per_rad",
                       .meaning = "κ, inverse of the speed of turning that halves the resistance",
                       .initial = 0.1,
                       .low = 0.0,
                       .high = 10.0}},
           .needs = {"omega_rad_s"},
           .passive = false},  // the turning hand does the work that a spring gives back
          made<BoneScale, RotationCoupling>};
}

}  // namespace effects::probing
}  // namespace tractus
