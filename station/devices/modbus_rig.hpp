/// The probing rig over Modbus. The only file of the station that knows libmodbus is
/// modbus_rig.cpp.
#pragma once

#include <memory>
#include <string>

#include "station/devices/rig_device.hpp"

namespace tractus::devices {

/// @param address  "HOST:PORT" (TCP) or a serial line "/dev/ttyUSB0", "/dev/ttyUSB0@115200" (RTU,
///                 8E1, 115200 unless said).
/// One FC 23 a period. Over TCP the answer is taken in one system call and known by the sequence
/// number that it echoes, so that one that comes late is never taken for the next. Errors of
/// making: bad_input for an address of neither kind.
core::Result<std::unique_ptr<RigDevice>> modbus_rig(const std::string& address);

}  // namespace tractus::devices
