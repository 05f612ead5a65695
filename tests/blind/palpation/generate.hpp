#pragma once
/// A palpation set made from its plan: hands moved, effects brought to strength, the base's share
/// judged, records taken.
#include "palpation/draw.hpp"

namespace blind {

struct PalpationSample {
  double t_s;
  Vec3 p_m;
  Eigen::Quaterniond q;
  Wrench wrench;
};

/// What became of one hidden effect; forces as norms.
struct PalpationOutcome {
  double rms_N = 0, strength = 0, projected_N = 0;
};

struct PalpationSet {
  PalpationPlan plan;
  bool accepted =
      false;  ///< strengths and sizes are as wanted; else the last of many tries was not
  std::vector<std::vector<PalpationSample>> trials;
  std::vector<PalpationOutcome> outcomes;
  double hidden_projected_N = 0, force_rms_N = 0, peak_N = 0;
  double sensor_floor_N = 0;  ///< RMS of the force noise's norm
  double pose_floor_N = 0;    ///< RMS of what the noise of the pose makes of the true law's force
  double jump_share = 0;      ///< share of milliseconds in which the shank snapped
};

PalpationSet generate_palpation(const PalpationRequest& request);

}  // namespace blind
