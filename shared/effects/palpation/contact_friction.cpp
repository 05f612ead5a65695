/// Coulomb friction where the probe slides on bone:  F = −μ |F_n| v_t/|v_t|.
///
/// F_n is the point's elastic force, whose direction is the wall's normal; v_t is what of the
/// point's velocity lies across it. The friction bends the shank like every other force, unless the
/// model says that it does not (see bends_shank).
/// Departs from the design by 1/√(1 + (v_ε/v_t)²), v_ε = 0.1 mm/s: without it a hand at rest would
/// feel the noise of its own velocity as chatter.
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

constexpr double kRoundedFriction_m_s = 1e-4;  // v_ε

class ContactFriction final : public PointForce {
 public:
  ContactFriction(double coefficient, double bending_share)
      : coefficient_(coefficient), bending_share_(bending_share) {}

  void add(const PointContact& point, const laws::ForceSample& elastic,
           laws::ForceSample& total) const noexcept override {
    const double normal_N = elastic.force_N.norm();
    if (!(normal_N > 1e-12)) return;
    const Vec3 n = elastic.force_N / normal_N, &v = point.v_m_s;
    const double v_n = v.dot(n);
    const Vec3 v_t = v - v_n * n;
    const double speed = std::sqrt(v_t.squaredNorm() + kRoundedFriction_m_s * kRoundedFriction_m_s);
    const Vec3 t = v_t / speed;
    total.force_N -= coefficient_ * normal_N * t;
    // d(|F| t) = t (nᵀ dF) + |F| dt;  dt = (1 − t tᵀ) dv_t/speed;  dv_t = −(n vᵀ + v_n) dn;
    // |F| dn = (1 − n nᵀ) dF
    const Mat3 across = elastic.jacobian_N_per_m - n * (n.transpose() * elastic.jacobian_N_per_m);
    const Mat3 dv_t = -(n * (v.transpose() * across) + v_n * across);
    total.jacobian_N_per_m -= coefficient_ * (t * (n.transpose() * elastic.jacobian_N_per_m) +
                                              (dv_t - t * (t.transpose() * dv_t)) / speed);
  }

  double bending_share() const noexcept override { return bending_share_; }

 private:
  double coefficient_, bending_share_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo contact_friction() {
  return {.facts = {.id = "contact_friction",
                    .label = "contact friction",
                    .kind = Kind::force,
                    .summary = "Dry friction where the probe slides on bone",
                    .equation = "F = −μ |F_n| v_t/|v_t| at each contact point",
                    .source = "own; sliding friction after Coulomb",
                    .experiment = "slides along one wall to and fro at 5, 20 and 60 mm/s",
                    .params = {{.name = "coefficient",
                                .meaning = "friction over normal force, μ",
                                .initial = 0.2,
                                .low = 0.0,
                                .high = 1.5,
                                .unit = "1",
                                .step = 2e-2},
                               bends_shank()},
                    .starts = {{0.1, 1.0}, {0.1, 0.0}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ContactFriction>(values[0], values[1]);
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
