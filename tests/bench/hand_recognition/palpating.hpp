/// A trial of the SIMULATED hand on a form of a case, in simulated time.
#pragma once

#include "bench/hand_recognition/forms.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus::bench {

/// What the hand says after `duration_s`. It knows what a station tells it: the planned tract, and
/// from which depth bone was seen all round.
devices::SimulatedAnswer palpated(const Form& form, const models::PalpationRuntime& runtime,
                                  std::uint64_t seed, double duration_s,
                                  const devices::HandSense& sense);

}  // namespace tractus::bench
