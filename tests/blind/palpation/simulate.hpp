#pragma once
/// The law along all trials of a plan.
#include "palpation/draw.hpp"

namespace blind {

/// A trial's wrenches, one per step; step k at k · dt_s.
using Wrenches = std::vector<Wrench>;

struct Simulated {
  std::vector<Wrenches> trials;
  double jump_share = 0;
};

/// Hands of a plan, one per trial.
std::vector<Palpation> hands_of(const PalpationPlan& plan);

/// Poses of a trial at k · dt_s, k = −1 … count: the first and last serve the velocities alone.
std::vector<Pose> poses_of(const Palpation& hand, double dt_s, std::size_t count);

/// `effects` includes those of the record (bias, drift, delay). `poses` per trial as poses_of gives
/// them.
Simulated simulate(const PalpationPlan& plan, const Field& field, const Probe& probe,
                   const std::vector<Hidden>& effects, const std::vector<std::vector<Pose>>& poses,
                   double dt_s);

}  // namespace blind
