/// A mass on the handle's axis, below the sensor: what its weight and its inertia have in common.
#pragma once

#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus::effects {

struct MassOnAxis {
  double mass_kg = 0.0;
  double centre_m = 0.0;  ///< from the sensor towards the tip

  /// The force F (in H) at its centre, as the sensor meets it: F, and c ẑ × F about the origin of
  /// H.
  void pull(const Vec3& force_N, math::Wrench& wrench_H) const noexcept {
    wrench_H.force_N += force_N;
    wrench_H.torque_Nm += centre_m * Vec3::UnitZ().cross(force_N);
  }
  static MassOnAxis of(std::span<const double> values) { return {values[0], values[1]}; }
  /// In the order of `of`.
  static std::vector<Param> params() {
    return {{.name = "mass_kg",
             .meaning = "mass below the sensor",
             .initial = 0.02,
             .low = 0.0,
             .high = 2.0,
             .step = 5e-3},
            {.name = "centre_m",
             .meaning = "its centre from the sensor towards the tip",
             .initial = 0.05,
             .low = -0.2,
             .high = 1.0,
             .off = kNoOff,
             .step = 5e-3}};
  }
  static Starts starts() { return {{0.01, 0.05}}; }
};

}  // namespace tractus::effects
