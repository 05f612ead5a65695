/// The burr: a ball that takes bone away while it turns and is pressed on.
#pragma once

#include <string>

#include "core/json.hpp"

namespace tractus::drilling {

///                 nose
///                |<-->|
///     ======( ball's . )  felt tip
///            centre
///
/// A voxel at the distance d < r from the ball's centre loses the share of itself
///
///     dm/dt = −ρ(F) (1 − d²/r²)                         own, after [Agus2003]   (1)
///     ρ(F)  = ρ₁ · clamp((F − F₀)/(F₁ − F₀), 0, 1)      own                     (2)
///
/// with F the size of the model's force as it was recorded. The felt tip lies ahead of the ball's
/// centre: where it is, (1) must still take something away, or a hand would never get on.
///
/// Assumes one bone: soft and hard voxels lose the same share in the same time. Known limits: the
/// force is that of the whole probe, so a shank that leans on a wall cuts a little faster; and it
/// is the palpation model's, which gives tenths of a newton in marrow: F₁ is small so that the burr
/// cuts there, and cortex then costs hardly more push than marrow. The numbers are plausible
/// choices of ours, tuned on the simulated hand in a lumbar CT, not measurements.
struct Burr {
  double radius_m = 0.0015;  ///< r, 0.0003 … 0.005
  double nose_m = 0.00075;   ///< felt tip ahead of the ball's centre, 0 … 0.9 r
  double rate_per_s = 40.0;  ///< ρ₁, of a voxel at the centre under full force, 0.01 … 1000
  double threshold_N =
      0.01;             ///< F₀, no bone goes below: the least contact that [Zoller2020] counts
  double full_N = 0.2;  ///< F₁, no faster above; > F₀, … 100
  /// Of the shaft, steel as the probe's: it takes the place of the model's radius, or the burr
  /// would bend away from what it cuts. 0.0003 … 0.005
  double shank_radius_m = 0.00125;

  /// ρ(F), eq. (2), 1/s.
  double rate_at_per_s(double force_N) const noexcept;
  core::Json to_json() const;
  /// Errors: bad_input naming `where` and the field.
  static core::Result<Burr> from_json(const core::Json& json, const std::string& where);
};

}  // namespace tractus::drilling
