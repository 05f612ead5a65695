/// Commands and readings as the rig's registers hold them; rig_registers.hpp has the addresses.
#pragma once

#include "station/devices/rig_device.hpp"

namespace tractus::devices {

/// @param at  kCommandCount registers
void put_command(const RigCommand& command, std::uint16_t sequence, std::uint16_t* at) noexcept;

/// @param image  kReadingCount registers. garbage, and `out` as it was, for values far beyond what
/// any rig of this kind does.
Exchange take_reading(const std::uint16_t* image, RigReading& out) noexcept;

/// @param found  kIdentityCount registers of the known version
RigIdentity identity_of(const std::uint16_t* found) noexcept;

}  // namespace tractus::devices
