/// Motions of the probing rig that excite what strokes alone may not.
#pragma once

#include <vector>

#include "trial/motion_program.hpp"

namespace tractus::lab {

/// Where a rig may go: what the recordings at hand have reached.
struct MotionRange {
  double least_m = 0.0, most_m = 0.0;
  double fastest_m_s = 0.08;
  bool turns = false;  ///< the probe may turn
};

/// Strokes at one and at many speeds, short quick ones, reversals of several sizes, steps with holds, short strokes at two
/// depths, strokes while turning: each of 10 to 40 s within the range.
std::vector<trial::MotionProgram> probing_programs(const MotionRange& range);

}  // namespace tractus::lab
