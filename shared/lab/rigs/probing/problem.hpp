/// Measurements of the probing rig against a probing model, ready for the lab's engine.
#pragma once

#include <memory>

#include "lab/identify/problem.hpp"
#include "lab/identify/user_effects.hpp"
#include "models/probing_model.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab {

struct ProbingOptions {
  int threads = 2;
  /// Judges the torque about the probe's axis, of a set whose trials all slide and turn, with both force and torque.
  bool torque_beside_force = false;
  UserEffects user_effects = {};  ///< the user's own effects, candidates as the catalogue's
};

/// Smooths and differentiates the motion, estimates the noise, and makes the problem. The set is
/// taken over. Errors: bad_input naming the trial and what is wrong with it: too short, too few
/// samples per second, no motion at all, a depth outside what the model's rig can reach.
core::Result<std::unique_ptr<Problem>> make_probing_problem(const models::ProbingModel& model,
                                                            trial::ProbingSet set,
                                                            const ProbingOptions& options = {},
                                                            const core::Progress& progress = {});

}  // namespace tractus::lab
