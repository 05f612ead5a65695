/// Bone that gives back less than it took: the elastic force of a contact point is F while the
/// point enters and F (1 − h) while it leaves.
///
/// It leaves when its velocity has a part along the force. The change from one to the other is
/// rounded over 0.03 mm/s: half of it at rest, all but 1/400 of it at 0.3 mm/s. A hand would feel the
/// jump as a click.
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

constexpr double kRoundedHysteresis_m_s = 3e-5;

class ContactHysteresis final : public ContactLoss {
 public:
  explicit ContactHysteresis(double loss) : loss_(loss) {}

  void change(const PointContact& point, laws::ForceSample& elastic) const noexcept override {
    const double F = elastic.force_N.norm();
    if (!(F > 1e-12)) return;
    const Vec3 n = elastic.force_N / F, &v = point.v_m_s;
    const double out = v.dot(n) / kRoundedHysteresis_m_s, root = std::sqrt(1.0 + out * out);
    const double share = 1.0 - 0.5 * loss_ * (1.0 + out / root);
    // dn = (1 − n nᵀ) dF/|F|, so F dshare = −½h/(v_ε root³) n vᵀ(1 − n nᵀ) dF
    const Vec3 v_t = v - v.dot(n) * n;
    const double slope = 0.5 * loss_ / (kRoundedHysteresis_m_s * root * root * root);
    elastic.jacobian_N_per_m = (share * elastic.jacobian_N_per_m -
                                slope * n * (v_t.transpose() * elastic.jacobian_N_per_m))
                                   .eval();
    elastic.force_N *= share;
  }

 private:
  double loss_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo contact_hysteresis() {
  return {.facts = {.id = "contact_hysteresis",
                    .label = "contact hysteresis",
                    .kind = Kind::force,
                    .summary = "Contact force that is smaller on the way out than on the way in",
                    .equation = "F (1 − h) while leaving, F while entering",
                    .source = "own",
                    .experiment = "slow presses into one wall and out again, ten times",
                    .params = {{.name = "loss",
                                .meaning = "share of the force that is lost on the way out, h",
                                .initial = 0.15,
                                .low = 0.0,
                                .high = 0.95,
                                .unit = "1",
                                .step = 2e-2}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ContactHysteresis>(values[0]);
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
