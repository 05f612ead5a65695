/// The simulated rig in this process, for trials in simulated time.
#pragma once

#include "station/devices/catalogue.hpp"
#include "station/session/probing_rig.hpp"

namespace tractus::session {

/// The electronics that `tractus-rig --bus-clock` puts behind Modbus, asked register by register
/// without the bus: the same bits for the same seed, and no system call a period. SIMULATED.
devices::MadeRig fast_rig(const RigSetup& setup);

}  // namespace tractus::session
