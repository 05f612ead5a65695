/// Motion, force and recipe to a measurement set.
#pragma once

#include "capture/recipe.hpp"
#include "capture/taps.hpp"
#include "trial/measurement_set.hpp"

namespace capture {

/// A force/torque recording in the sensor's frame S, at its origin.
struct ForceTrack {
  std::vector<double> t_s;  ///< strictly increasing, of the sensor's clock
  std::vector<math::Wrench> wrench_S;
};

/// `t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm`. Errors: as trial::read_csv; bad_input where time does
/// not run forward or with fewer than two rows.
core::Result<ForceTrack> read_force(const std::filesystem::path& path);

/// What was found on the way to a trial.
struct Assembled {
  trial::PalpationMeasurement trial;
  ClockOffset clock;    ///< sd_s is 0 and no taps are there when the recipe states the offset
  math::Wrench zero_S;  ///< the sensor's zero, taken off
  double rate_Hz = 0.0;
  double unseen = 0.0;  ///< share of the kept time in which a body was not seen
};

/// One recording of the recipe.
///
///     X_VH(t) = (X_CB_bone X_BV)⁻¹ X_CB_tool X_BH                                       (1)
///     f_H = R_HS (f_S − zero),   τ_H = R_HS (τ_S − zero) + p_HS × f_H                     (2)
///
/// at the motion's frames (or `rate_Hz`); the force is its mean over the row's period about the
/// row's instant on the sensor's clock, so that it is neither late nor aliased. Kept is what
/// follows the last tap by half a second or more, where tool, bone and force were all seen. Errors:
/// bad_input naming the body, the taps or the file.
core::Result<Assembled> assemble(const Recipe& recipe, const Recording& recording);

}  // namespace capture
