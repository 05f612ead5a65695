#include <cmath>
#include <numbers>

#include "palpation/law.hpp"

namespace blind {

Shank bend(const Probe& probe, double handle_radius_m, double tip_radius_m) {
  // v'' = (L − z) / (E I(z)) under unit force at the tip; both integrals by the midpoint rule.
  constexpr int kSteps = 20000;
  const double length = probe.length_m, h = length / kSteps;
  std::vector<double> v(kSteps + 1, 0.0);
  double slope = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = (i + 0.5) * h;
    const double r = handle_radius_m + (tip_radius_m - handle_radius_m) * z / length;
    const double curvature =
        (length - z) / (probe.youngs_modulus_Pa * std::numbers::pi * std::pow(r, 4) / 4);
    const auto k = static_cast<std::size_t>(i);
    v[k + 1] = v[k] + h * (slope + 0.5 * h * curvature);
    slope += h * curvature;
  }
  Shank out;
  out.stiffness_N_per_m = 1.0 / v.back();
  for (int i = 0; i < probe.points; ++i) {
    const double z = length - i * probe.point_spacing_m;
    out.z_m.push_back(z);
    const double at = z / h;
    const auto k = std::min(static_cast<std::size_t>(at), v.size() - 2);
    const double f = at - static_cast<double>(k);
    out.shape.push_back(((1 - f) * v[k] + f * v[k + 1]) / v.back());
  }
  return out;
}

}  // namespace blind
