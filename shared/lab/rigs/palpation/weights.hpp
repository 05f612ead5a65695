/// What is not known of a palpation's motion, as the model passes it on: the weights of a fit.
#pragma once

#include "lab/rigs/palpation/recording.hpp"

namespace tractus::lab {

/// What is expected of each instant if `runtime` were true: the sensor's noise, the pose's error as
/// the model passes it on, and where the shank snaps from one rest to another the size of the jump,
/// whose moment is known to a few samples only. Samples are not judged that lie at such a snap, where
/// the shank may rest in several places, or where more of the force than
/// PalpationWeightsSettings::poorly_known_factor of the sensor's noise is not known: by the pose's
/// error, or by a velocity so slow that nobody knows where friction points.
/// Follows the shank's rests anew and keeps them.
void weigh(const models::PalpationRuntime& runtime, PalpationRecording& recording);

}  // namespace tractus::lab
