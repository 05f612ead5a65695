/// The published pictures of a replay: one trial against time, and the distributions of all.
#pragma once

#include <optional>
#include <span>

#include "plot/figure.hpp"
#include "replay/replay.hpp"
#include "trial/measurement_set.hpp"

namespace tractus::replay {

/// The probe as the pictures need it.
struct ProbePlace {
  double length_m;           ///< L, from the sensor to the tip
  math::Vec3 pose_offset_m;  ///< of the model, added to recorded positions
};

/// Three panels against time, measured and simulated, as [Zoller2020, Fig. 2]: F_z with the
/// distance from the sensor to the tract's entrance along its axis, F_xy with the sensor's distance
/// from that axis, T_xy with the angle between tract and handle. Without a tract the first shows
/// the sensor's z in V and the others the force alone.
plot::Figure trial_figure(const trial::PalpationMeasurement& recording, const Replayed& replayed,
                          const std::optional<trial::StatedTract>& tract, const ProbePlace& probe);

/// F_xy, F_z, T_xy, T_z: simulated filled, measured as a line, as [Zoller2020, Fig. 5]; densities
/// by decades. F_z and T_z with their sign.
plot::Figure distribution_figure(std::span<const math::Wrench> measured,
                                 std::span<const math::Wrench> simulated);

}  // namespace tractus::replay
