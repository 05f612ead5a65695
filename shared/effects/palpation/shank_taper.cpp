/// A shank that is thinner (or thicker) at its tip: the radius goes linearly from handle to tip,
/// and with it the bending stiffness. For a force F across the tip, E I(z) v″ = F (L − z), so
///
///     v(z)/F = ∫₀ᶻ (z − s)(L − s)/(E I(s)) ds,   I = π r(s)⁴/4,   k = F/v(L),   φ(z) = v(z)/v(L)
///
/// Equal radii are the uniform shank of that radius.
#include <array>
#include <cmath>

#include "effects/palpation_effect.hpp"
#include "laws/palpation_law.hpp"

namespace tractus {
namespace effects {
namespace {

/// Gauss–Legendre on panels, eight points each: the integrand is a polynomial over r⁴.
constexpr std::array<std::array<double, 2>, 4> kGauss{{{0.1834346424956498, 0.3626837833783620},
                                                       {0.5255324099163290, 0.3137066458778873},
                                                       {0.7966664774136267, 0.2223810344533745},
                                                       {0.9602898564975363, 0.1012285362903763}}};
constexpr int kPanels = 16;

template <class Function>
double integral(const Function& f, double to) {
  double sum = 0.0;
  const double half = 0.5 * to / kPanels;
  for (int panel = 0; panel < kPanels; ++panel)
    for (const auto& [x, w] : kGauss)
      for (const double side : {-x, x}) sum += w * half * f(half * (2 * panel + 1 + side));
  return sum;
}

class ShankTaper final : public ShankForm {
 public:
  ShankTaper(double handle_radius_m, double tip_radius_m)
      : handle_m_(handle_radius_m), tip_m_(tip_radius_m) {}

  void form(laws::Shank& shank) const noexcept override {
    const double tip_m_per_N = compliance_m_per_N(shank, shank.length_m);
    shank.stiffness_N_per_m = 1.0 / tip_m_per_N;
    for (std::size_t i = 0; i < std::size_t(shank.points); ++i)
      shank.shape[i] = compliance_m_per_N(shank, shank.z_m[i]) / tip_m_per_N;
  }

 private:
  /// v(z)/F.
  double compliance_m_per_N(const laws::Shank& shank, double z) const noexcept {
    const double L = shank.length_m;
    return integral(
        [&](double s) {
          const double r = handle_m_ + (tip_m_ - handle_m_) * s / L;
          const double EI = shank.youngs_modulus_Pa * M_PI * r * r * r * r / 4.0;
          return (z - s) * (L - s) / EI;
        },
        z);
  }
  double handle_m_, tip_m_;
};

Param radius(const char* name, const char* meaning, double initial) {
  return {.name = name,
          .meaning = meaning,
          .initial = initial,
          .low = 5e-5,
          .high = 0.02,
          .off = kNoOff,
          .logarithmic = true};
}

}  // namespace

namespace palpation {
PalpationEffectInfo shank_taper() {
  return {.facts = {.id = "shank_taper",
                    .label = "shank taper",
                    .kind = Kind::structure,
                    .summary = "A shank whose radius changes linearly from handle to tip",
                    .equation = "r(z) = r_h + (r_t − r_h) z/L; k and φ from E I(z) v″ = F (L − z)",
                    .source = "own; beam theory",
                    .experiment = "sideways presses with the tip alone, and with the shank a few "
                                  "centimetres behind it",
                    .params = {radius("handle_radius_m", "radius where the shank leaves the handle",
                                      8e-4),
                               radius("tip_radius_m", "radius at the tip", 6e-4)}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ShankTaper>(values[0], values[1]);
          },
          .starts = [](const PalpationStatistics& known) -> Starts {
            return {{1.02 * known.radius_m, 1.02 * known.radius_m}};
          },
          .replaces = &laws::PalpationParameters::radius_m};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
