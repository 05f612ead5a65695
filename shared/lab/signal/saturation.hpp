/// The ends of a force sensor's range, as recordings show them.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tractus::lab {

/// Ends of a sensor's range, in its channel's unit; an end that no recording reached is absent.
struct SensorRange {
  std::optional<double> least, most;

  bool ends_at(double value) const { return value == least || value == most; }
};

/// Whether noise of `noise_sd` (0: none is known of) shows beside the usual step between neighbours. Without it a recording does
/// not tell a sensor at its end from a force that was held.
bool shows_noise(std::span<const double> recording, double noise_sd);

/// The range of one channel from all its recordings. An extreme value is an end of the range where samples pile up at it:
/// they are many more than those of the next three values inwards together. Without an end the values thin out
/// towards the extreme; at the smooth peak of a noiseless force, where they do not, the extreme value has as many
/// samples as the next three together.
SensorRange sensor_range(std::span<const std::span<const double>> recordings);

}  // namespace tractus::lab
