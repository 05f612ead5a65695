/// Drag that grows with the square of the speed: F = c v |v|.
#include <cmath>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class QuadraticDrag final : public ProbingEffect {
 public:
  explicit QuadraticDrag(std::span<const double> values) : coefficient_Ns2_per_m2_(values[0]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::force; }
  double force_N(const ProbingTick& tick, double, const double*) const noexcept override {
    return coefficient_Ns2_per_m2_ * tick.v_m_s * std::abs(tick.v_m_s);
  }

 private:
  double coefficient_Ns2_per_m2_;
};

}  // namespace

ProbingEffectInfo quadratic_drag() {
  return {{.id = "quadratic_drag",
           .kind = Kind::force,
           .summary = "Drag that grows with the square of the speed, as of a fluid pressed aside",
           .equation = "c v |v|",
           .source = "own",
           .params = {{.name = "coefficient_Ns2_per_m2",
                       .meaning = "c, drag per speed squared",
                       .initial = 1e3,
                       .low = 0.0,
                       .high = 1e7}}},
          made<QuadraticDrag>};
}

}  // namespace effects::probing
}  // namespace tractus
