/// A recorded channel moved in time.
#pragma once

#include <span>

namespace tractus::effects {

/// Moves `values`, one per moment, so that what is at t was at t − delay before. Between samples by cubic Hermite
/// interpolation with central differences as slopes; before the first sample its value holds, after the last the last's.
/// @param delay_s  below 0: earlier.
void delay(std::span<const double> t_s, double delay_s, std::span<double> values);

}  // namespace tractus::effects
