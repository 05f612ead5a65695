/// Drag that grows with the square of the speed: F = c v |v|.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class QuadraticDrag final : public ProbeForce {
 public:
  explicit QuadraticDrag(std::span<const double> values) : coefficient_Ns2_per_m2_(values[0]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return coefficient_Ns2_per_m2_ * tick.v_m_s * std::abs(tick.v_m_s);
  }

 private:
  double coefficient_Ns2_per_m2_;
};

}  // namespace

ProbingEffectInfo quadratic_drag() {
  return {{.id = "quadratic_drag",
           .label = "quadratic drag",
           .kind = Kind::force,
           .summary = "Drag that grows with the square of the speed, as of a fluid pressed aside",
           .equation = "c v |v|",
           .source = "own",
           .experiment = "strokes at 2, 10, 30 and 80 mm/s over the same depth",
           .params = {{.name = "coefficient_Ns2_per_m2",
                       .meaning = "c, drag per speed squared",
                       .initial = 1e3,
                       .low = 0.0,
                       .high = 1e7}}},
          made<ProbeForce, QuadraticDrag>};
}

}  // namespace effects::probing
}  // namespace tractus
