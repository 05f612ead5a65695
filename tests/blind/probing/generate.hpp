#pragma once
/// A set made from its plan: trials moved, effects brought to their strength, records taken.
#include <vector>

#include "probing/draw.hpp"
#include "probing/record.hpp"

namespace blind {

/// What became of one hidden effect.
struct Outcome {
  double rms_N = 0;     ///< of the force with it minus the force without it, on the same motion
  double strength = 0;  ///< that over the RMS of the force
  double projected_N =
      0;  ///< what is left of it once the free base parameters have moved to hide it
};

struct GeneratedSet {
  SetPlan plan;
  bool accepted =
      false;  ///< strengths and sizes are as wanted; else the last of many tries was not
  std::vector<Samples> trials;
  std::vector<Outcome> outcomes;
  double force_rms_N = 0, floor_N = 0, stuck_share = 0;
  /// RMS of the record minus the true law on the motion as sampled, without noise: all samples, and
  /// those farther than 10 samples from a change of layer (where a jump within one sample is
  /// nobody's to tell).
  double attainable_N = 0, attainable_away_N = 0;
  double hidden_projected_N = 0;  ///< all effects together
};

GeneratedSet generate(const Request& request);

}  // namespace blind
