/// Viscous resistance of what the probe moves through:  F = −c (ω∗α)(p) v  at each contact point.
#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

class ContactDamping final : public PointForce {
 public:
  ContactDamping(double damping_Ns_per_m, double bending_share)
      : damping_Ns_per_m_(damping_Ns_per_m), bending_share_(bending_share) {}

  void add(const PointContact& point, const laws::ForceSample&,
           laws::ForceSample& total) const noexcept override {
    const Vec3 drag_N = -damping_Ns_per_m_ * point.v_m_s;
    total.force_N += point.field->opacity(point.p_m) * drag_N;
    total.jacobian_N_per_m -= drag_N * point.field->gradient_per_m(point.p_m).transpose();
  }

  double bending_share() const noexcept override { return bending_share_; }

 private:
  double damping_Ns_per_m_, bending_share_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo contact_damping() {
  return {
      .facts = {.id = "contact_damping",
                .label = "contact damping",
                .kind = Kind::force,
                .summary = "Viscous drag of a contact point, in proportion to the bone it is in",
                .equation = "F = −c (ω∗α)(p) v at each contact point",
                .source = "own",
                .experiment = "presses into one wall at 2, 10 and 40 mm/s, each held for 2 s",
                .params = {{.name = "damping_Ns_per_m",
                            .meaning = "force over speed in solid bone, c",
                            .initial = 5.0,
                            .low = 0.0,
                            .high = 500.0,
                            .step = 1.0},
                           bends_shank()},
                .starts = {{10.0, 1.0}, {10.0, 0.0}}},
      .make = [](std::span<const double> values) -> PalpationEffect {
        return std::make_unique<ContactDamping>(values[0], values[1]);
      }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
