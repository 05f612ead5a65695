/// What is not known of a palpation's motion, as the model passes it on: the weights of a fit.
#pragma once

#include "lab/rigs/palpation/recording.hpp"

namespace tractus::lab {

/// What is expected of each instant if `runtime` were true: the sensor's noise, the pose's error as
/// the model passes it on, and where the shank snaps from one rest to another the size of the jump,
/// whose moment is known to a few samples only. Samples are not judged that lie at such a snap, or
/// where a pressed point moves so slowly along or across its force that the sign is not known (what
/// friction and losses do there is not known either).
/// Follows the shank's rests anew and keeps them.
void weigh(const models::PalpationRuntime& runtime, PalpationRecording& recording);

}  // namespace tractus::lab
