#include "laws/shank.hpp"

#include <algorithm>
#include <cmath>

#include "laws/palpation_law.hpp"

namespace tractus::laws {

Shank Shank::uniform(const PalpationParameters& p) {
  Shank out;
  const double inertia_m4 = M_PI * std::pow(p.radius_m, 4) / 4.0;
  const double L = p.length_m;
  out.length_m = L;
  out.youngs_modulus_Pa = p.youngs_modulus_Pa;
  out.stiffness_N_per_m = 3.0 * p.youngs_modulus_Pa * inertia_m4 / (L * L * L);
  out.points = p.points;
  out.rest_m.fill(math::Vec2::Zero());
  for (int i = 0; i < p.points; ++i) {
    const double z = std::max(L - i * p.point_spacing_m, 0.0);
    out.z_m[std::size_t(i)] = z;
    out.shape[std::size_t(i)] = z * z * (3.0 * L - z) / (2.0 * L * L * L);  // (4), 1 at the tip
  }
  return out;
}

}  // namespace tractus::laws
