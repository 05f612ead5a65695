/// What decides whether the rig may move: enabling, watchdog, faults, e-stop.
#pragma once

#include <cstdint>

#include "station/devices/rig_registers.hpp"

namespace tractus::rig {

using devices::rig::RigFault;

/// What people and breakdowns do to the electronics in one step.
struct Panel {
  bool stop_pressed = false, reset_pressed = false, drive_error = false, start_pressed = false;
};

/// The logic of the electronics, stepped with the physics.
///
/// The drive is enabled by a rising edge of the control bit, when there is neither fault nor
/// e-stop. A fault disables it and stays until a rising edge of the reset bit; then the enable bit
/// must rise anew. An e-stop latches: no command clears it, only a person who releases the button
/// and presses reset at the panel.
class Drive {
 public:
  /// A command block has arrived.
  void command(std::uint16_t control) noexcept;
  /// One step of the electronics.
  /// @param stalled, overloaded  what the actuator and the sensor report.
  void step(const Panel& panel, bool stalled, bool overloaded, double dt_s) noexcept;

  bool enabled() const noexcept { return enabled_; }
  bool emergency() const noexcept { return emergency_; }
  bool rotary_on() const noexcept { return rotary_on_ && !emergency_; }
  RigFault fault() const noexcept { return fault_; }

 private:
  void fail(RigFault fault) noexcept;
  std::uint16_t control_ = 0;
  bool enabled_ = false, emergency_ = false, rotary_on_ = false, reset_was_pressed_ = false;
  RigFault fault_ = RigFault::none;
  double silent_s_ = 0.0;
};

}  // namespace tractus::rig
