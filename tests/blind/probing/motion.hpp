#pragma once
/// How a trial moves: a person's hand against the bone, that hand's path played back, or a
/// programmed stage.
#include <vector>

#include "probing/law.hpp"

namespace blind {

/// Time step of everything before sampling.
inline constexpr double kFineStep_s = 5e-5;

enum class Mode {
  kHand,        ///< closed loop: the hand pushes, the bone with its hidden effects answers
  kPlayedHand,  ///< a hand's path, smoothed, driven along whatever the force
  kProgrammed,  ///< strokes, ramps, holds and multi-sines of a machine
};

/// What one trial is asked to do. Depths are of the tip.
struct TrialPlan {
  Mode mode = Mode::kHand;
  double duration_s = 8, low_m = 0, high_m = 0.01;
  double hand_N_per_m = 15000, tremor_m = 5e-5, smoothing_Hz = 18;
  double air_s = 0;  ///< time spent before the entry, in the open
  std::uint64_t seed = 0;
};

/// A trial at the fine step.
struct Series {
  std::vector<Moment> moments;
  std::vector<double> force_N;
  double stuck_share = 0;  ///< share of time that friction held the hand still
};

/// Motion and, for a hand, the force that the hand gave. For the other modes the force is left
/// empty: evaluate().
Series move(const TrialPlan& plan, Physics& physics, const TrialContext& trial);

/// The law's force along a motion.
std::vector<double> evaluate(const Series& series, Physics& physics, const TrialContext& trial);

}  // namespace blind
