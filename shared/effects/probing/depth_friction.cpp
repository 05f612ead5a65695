/// Dry friction along the shank that grows with the contact length: F = μ x sgn v.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class DepthFriction final : public ProbeForce {
 public:
  explicit DepthFriction(std::span<const double> values) : slope_N_per_m_(values[0]) {}
  /// Before the entry (x < 0) nothing touches.
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    const double inside_m = tick.x_m > 0.0 ? tick.x_m : 0.0;
    return slope_N_per_m_ * inside_m * direction(tick.v_m_s, tick.rest_m_s);
  }

 private:
  double slope_N_per_m_;
};

}  // namespace

ProbingEffectInfo depth_friction() {
  return {{.id = "depth_friction",
           .label = "depth friction",
           .kind = Kind::force,
           .summary = "Dry friction along the shank that grows with the contact length",
           .equation = "μ x sgn v, x ≥ 0",
           .source = "own",
           .experiment = "short strokes of 3 mm in and out, at a small depth and at a great one",
           .params = {{.name = "slope_N_per_m",
                       .meaning = "μ, friction per depth",
                       .initial = 50.0,
                       .low = 0.0,
                       .high = 2e4}},
           .is_dry = true},
          made<ProbeForce, DepthFriction>};
}

}  // namespace effects::probing
}  // namespace tractus
