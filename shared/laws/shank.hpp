/// The probe's shank as the palpation law needs it: how stiff it is and how it bends.
#pragma once

#include <array>

#include "math/geometry.hpp"

namespace tractus::laws {

struct PalpationParameters;

inline constexpr int kMaxPoints = 64;

/// A cantilever clamped at the handle and pushed across at its contact points. The published one
/// is uniform and straight; an effect of structure may change it.
struct Shank {
  double length_m = 0.0;                   ///< L
  double youngs_modulus_Pa = 0.0;          ///< E
  double stiffness_N_per_m = 0.0;          ///< k, of the tip against a force across it
  int points = 0;                          ///< n
  std::array<double, kMaxPoints> z_m{};    ///< z_i, from the tip on; the first n are set
  std::array<double, kMaxPoints> shape{};  ///< φ(z_i): deflection there over that of the tip
  /// Where the unloaded shank lies off ẑ at z_i, along x and y of H.
  std::array<math::Vec2, kMaxPoints> rest_m;
  bool straight = true;  ///< rest_m is zero throughout

  /// k = 3EI/L³, I = π r⁴/4;  z_i = L − i·spacing;  φ(z) = z²(3L − z)/(2L³);  straight
  /// [Zoller2020, eq. (4)].
  static Shank uniform(const PalpationParameters& parameters);
};

}  // namespace tractus::laws
