/// The tip's way and the force of a trial on an even grid, for either rig.
#pragma once

#include <functional>
#include <vector>

#include "metrics/metric.hpp"
#include "metrics/motion.hpp"

namespace tractus::metrics {

inline constexpr double kMotionRate_Hz = 200.0;

/// 200 Hz, straight between samples. Palpation: the bent tip in the volume's frame, and the size of
/// the model's force. Probing: (depth, 0, 0) of the motion, and the push.
struct TipMotion {
  std::vector<math::Vec3> points_m;
  std::vector<double> force_N;
  std::string why_not;  ///< set when there is none
};
const TipMotion& tip_motion(const Subject& subject);

/// A score made from the tip's kinematics; no value, and why, for a trial too short for them.
Score score_of_kinematics(
    const Subject& subject,
    const std::function<std::optional<double>(const TipMotion&, const Kinematics&)>& score);

}  // namespace tractus::metrics
