/// A motion that the probing rig plays by itself, as `tractus-program/1`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::trial {

/// One move from where the one before ended: both stages start together, and the move is over when both have arrived and
/// the hold has passed.
struct Move {
  double to_m = 0.0, speed_m_s = 0.0;  ///< depth of the tip and the most speed on the way, > 0
  double to_rad = 0.0, speed_rad_s = 0.0;
  double hold_s = 0.0;
};

/// A motion of both stages, one entry per moment.
struct PlannedMotion {
  std::vector<double> t_s, x_m, v_m_s, a_m_s2, theta_rad, omega_rad_s;

  std::size_t size() const { return t_s.size(); }
};

struct MotionProgram {
  std::string name;   ///< "slow strokes"
  std::string words;  ///< as the object of "record"
  double start_m = 0.0, start_rad = 0.0;
  double acceleration_m_s2 = 0.4, acceleration_rad_s2 = 20.0;  ///< mean, from rest to speed
  std::vector<Move> moves = {};

  double seconds() const;
  /// Position, speed and acceleration every `spacing_s`, from rest to rest.
  PlannedMotion motion(double spacing_s) const;
  core::Json to_json() const;
  /// Errors: bad_input naming the field: another format or rig, a number that is not finite, a speed that is not positive, no
  /// move, more than 10 minutes.
  static core::Result<MotionProgram> from_json(const core::Json& json, const std::string& where);
};

}  // namespace tractus::trial
