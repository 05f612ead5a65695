/// The probing rig as the station's loop sees it: one exchange a period.
#pragma once

#include <cstdint>

#include "core/result.hpp"
#include "station/devices/rig_registers.hpp"

namespace tractus::devices {

/// What the machine says of itself.
struct RigIdentity {
  double travel_m = 0.0;
  double top_speed_m_s = 0.0;
  bool simulated = false;  ///< nothing behind the registers is a machine
  bool bus_clock = false;  ///< simulated, and its clock moves by one period with every command
};

/// What is asked of it for the next period.
struct RigCommand {
  double speed_m_s = 0.0;    ///< of the linear stage, positive into the bone
  double torque_Nm = 0.0;    ///< of the rotary motor, positive along theta
  bool enable = false;       ///< acts on its rising edge
  bool reset_fault = false;  ///< acts on its rising edge
  bool rotary_on = false;
};

/// A coherent sample of one instant.
struct RigReading {
  std::uint16_t status = 0;  ///< bits of rig::Status
  rig::RigFault fault = rig::RigFault::none;
  double x_m = 0.0, speed_m_s = 0.0;
  std::int32_t angle_urad = 0;  ///< wraps
  double turning_rad_s = 0.0;
  double fz_N = 0.0, tz_Nm = 0.0;  ///< of the hand on the probe
};

/// How an exchange went; the loop decides what follows.
enum class Exchange : std::uint8_t {
  ok,
  silent,   ///< no answer in time; a later one is dropped
  garbage,  ///< what came is not an answer to what was asked
  gone,     ///< the line is closed
};

/// One rig, one owner.
class RigDevice {
 public:
  virtual ~RigDevice() = default;
  /// May block, a second at most. Errors: unavailable naming the address and what is wrong.
  virtual core::Result<RigIdentity> open() = 0;
  /// Commands and reads in one request. Blocks for kAnswer_ms (kPatient_ms) at most; no throw, no allocation.
  virtual Exchange exchange(const RigCommand& command, RigReading& reading) noexcept = 0;
  /// Commands standstill first; may be called twice.
  virtual void close() noexcept = 0;

  /// An answer that takes longer is none: below the machine's watchdog.
  static constexpr int kAnswer_ms = 4;
  /// A machine whose clock is on the bus waits for us, and we for it.
  static constexpr int kPatient_ms = 5000;
};

}  // namespace tractus::devices
