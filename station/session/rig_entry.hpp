/// Before a trial: is the rig well, and is its stage at the entry?
#pragma once

#include "core/clock.hpp"
#include "station/devices/rig_device.hpp"

namespace tractus::session {

/// Clears a fault that an earlier trial left, and moves the stage slowly out to x = 0 if it is not
/// there, ten seconds at most; the drive is off afterwards. Not in the tick.
/// @param rate_Hz  of the exchanges
/// Errors: unavailable, one line: no answer, e-stop, a fault that does not clear, a hand on the
/// probe, a stage that does not arrive.
core::Result<void> bring_to_entry(devices::RigDevice& device, core::Clock& clock, double rate_Hz);

}  // namespace tractus::session
