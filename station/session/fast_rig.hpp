/// The simulated rig in this process, for trials in simulated time.
#pragma once

#include <memory>

#include "station/devices/rig_device.hpp"
#include "station/session/probing_trial.hpp"

namespace tractus::session {

/// The electronics that `tractus-rig --bus-clock` puts behind Modbus, asked register by register
/// without the bus: the same bits for the same seed, and no system call a period. SIMULATED.
std::unique_ptr<devices::RigDevice> fast_rig(const RigSetup& setup);

}  // namespace tractus::session
