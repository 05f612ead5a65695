/// Why a hand is given nothing any more.
#pragma once

#include <cstdint>

namespace tractus::safety {

/// One list for the hand's device and the probing rig. Each latches.
enum class Fault : std::uint8_t {
  none,
  not_finite,  ///< a pose or a force was not a number
  jump,
  speed,
  stale,       ///< no fresh sample for too long
  device,      ///< the device says so itself
  unplugged,   ///< it is not on its bus any more
  forces_off,  ///< the device took its own forces away: button, velocity guard, watchdog
  silent,      ///< the rig did not answer for too long
  garbage,     ///< what came back was not an answer
  gone,        ///< the line to the rig was closed
  emergency,   ///< the e-stop
  stalled,     ///< the drive's load was above its thrust
  drive,       ///< the drive's own error
  sensor,      ///< the sensor was beyond its range
  watchdog,    ///< the rig stopped by itself too often, for want of commands
  pushed,      ///< the push stayed above its limit
  hand_on,     ///< somebody pushed while the sensor was tared
};

inline constexpr int kFaults = 18;

/// "the device's pose jumped", …: one line for a person, and what to do.
const char* text_of(Fault fault) noexcept;

}  // namespace tractus::safety
