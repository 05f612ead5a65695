/// Contact that stiffens (p > 1) or softens (p < 1) with the field:  F = c_f g (|g|/g₀)^(p−1).
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

// Below this the power of a softening contact would rise without end: |g| of a wall is hundreds.
constexpr double kLeast_per_m = 1e-6;

class ContactNonlinearity final : public ContactField {
 public:
  ContactNonlinearity(double exponent, double reference_per_m)
      : power_(exponent - 1.0), reference_per_m_(reference_per_m) {}

  void change(volume::FieldSample& at) const noexcept override {
    const double g = at.g_per_m.norm();
    if (!(g > kLeast_per_m)) {
      if (power_ > 0.0) at.g_per_m.setZero(), at.jacobian_per_m2.setZero();
      return;
    }
    const double scale = std::pow(g / reference_per_m_, power_);
    // d(g |g|^q) = |g|^q (1 + q ĝ ĝᵀ) dg,  q = p − 1
    const Vec3 unit = at.g_per_m / g;
    at.jacobian_per_m2 =
        scale *
        (at.jacobian_per_m2 + power_ * unit * (unit.transpose() * at.jacobian_per_m2)).eval();
    at.g_per_m *= scale;
  }

 private:
  double power_, reference_per_m_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo contact_nonlinearity() {
  return {.facts = {.id = "contact_nonlinearity",
                    .label = "contact nonlinearity",
                    .kind = Kind::force,
                    .summary = "Contact force that grows otherwise than in proportion to the field",
                    .equation = "F = c_f g (|g|/g₀)^(p−1)",
                    .source = "own",
                    .experiment = "slow presses into one wall, from light to as hard as is safe",
                    .params = {{.name = "exponent",
                                .meaning = "p; the force grows with the p-th power of the field",
                                .initial = 1.2,
                                .low = 0.3,
                                .high = 3.0,
                                .off = 1.0,
                                .unit = "1",
                                .step = 2e-2},
                               {.name = "reference_gradient_per_m",
                                .meaning = "g₀, the field at which nothing changes",
                                .initial = 500.0,
                                .low = 1.0,
                                .high = 1e5,
                                .off = kNoOff,
                                .logarithmic = true,
                                .prior_sd = 3.0}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ContactNonlinearity>(values[0], values[1]);
          },
          // Barely stiffening about a field that occurs.
          .starts = [](const PalpationStatistics& known) -> Starts {
            return {{1.05, known.field_per_m}};
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
