/// Motion, force and recipe to a measurement set.
#pragma once

#include <optional>

#include "capture/clock.hpp"
#include "capture/force.hpp"
#include "capture/recipe.hpp"
#include "trial/measurement_set.hpp"

namespace tractus::capture {

/// A run of taps as both recordings have it, on the motion's clock: for a person to look at.
struct TapView {
  std::vector<double> force_t_s, force_N;  ///< tared, its norm
  std::vector<double> way_t_s, way_m;      ///< of the tip, into the surface; 0 at its deepest
};

/// What was found on the way to a trial.
struct Assembled {
  trial::PalpationMeasurement trial;
  ClockFit clock;
  std::vector<TapView> taps;  ///< for each of the clock's runs
  math::Wrench zero_S;        ///< the sensor's zero, taken off
  double rate_Hz = 0.0;
  double unseen = 0.0;  ///< share of the kept time in which a body was not seen
  /// Between the force on the probe at the taps' peaks and the way out of the surface, which pushes
  /// it there: near 0, or near π where the sensor says the opposite. Nothing without taps.
  std::optional<double> push_off_rad;
};

/// One recording of the recipe.
///
///     X_VH(t) = (X_CB_bone X_BV)⁻¹ X_CB_tool X_BH                                       (1)
///     f_H = R_HS (f_S − zero),   τ_H = R_HS (τ_S − zero) + p_HS × f_H                     (2)
///
/// at the motion's frames (or `rate_Hz`); the force is its mean over the row's period about the
/// row's instant on the sensor's clock, so that it is neither late nor aliased. Kept is what lies
/// half a second or more after the first run of taps and before a last one, where tool, bone and
/// force were all seen. A recording whose motion and force are one file needs no taps. Errors:
/// bad_input naming the body, the taps or the file.
core::Result<Assembled> assemble(const Recipe& recipe, const Recording& recording);

}  // namespace tractus::capture
