/// Measurements of palpations against a palpation model, ready for the lab's engine.
#pragma once

#include <memory>

#include "lab/identify/problem.hpp"
#include "lab/identify/user_effects.hpp"
#include "models/model.hpp"
#include "trial/measurement_set.hpp"
#include "volume/volume.hpp"

namespace tractus::lab {

struct PalpationOptions {
  int threads = 2;
  UserEffects user_effects = {};  ///< the user's own effects, candidates as the catalogue's
};

/// Smooths and differentiates the poses, estimates the noise, makes the force field and the
/// problem. The set is taken over; the volume is only read here.
///
/// Each output's six residuals (force and torque in H) are made independent of each other by the
/// inverse of what is expected of them together: the sensor's noise, and the error of the smoothed
/// pose as the model passes it on — much along the axis of the handle, where bone pushes back
/// unsoftened, little across it, where the shank gives way.
///
/// Errors: bad_input naming the trial and what is wrong with it: too few samples, too slow, no
/// contact with the model's bone in any trial.
core::Result<std::unique_ptr<Problem>> make_palpation_problem(const models::PalpationModel& model,
                                                              trial::PalpationSet set,
                                                              const volume::Volume& volume,
                                                              const PalpationOptions& options = {},
                                                              const core::Progress& progress = {});

}  // namespace tractus::lab
