#include "station/rig/drive.hpp"

namespace tractus {
namespace rig {

namespace {
constexpr double kWatchdog_s = 1e-3 * devices::rig::kWatchdog_ms;
constexpr double kNearly_s = 1e-9;  // sums of steps are not exact
}  // namespace

void Drive::fail(RigFault fault) noexcept {
  enabled_ = false;
  rotary_on_ = false;
  if (fault_ == RigFault::none || fault == RigFault::emergency) fault_ = fault;
}

void Drive::command(std::uint16_t control) noexcept {
  const std::uint16_t rising = control & static_cast<std::uint16_t>(~control_);
  control_ = control;
  silent_s_ = 0.0;
  if ((rising & devices::rig::kResetFault) && !emergency_) fault_ = RigFault::none;
  const bool healthy = fault_ == RigFault::none && !emergency_;
  if (!(control & devices::rig::kEnable)) enabled_ = false;
  if ((rising & devices::rig::kEnable) && healthy) enabled_ = true;
  rotary_on_ = healthy && (control & devices::rig::kRotaryOn);
}

void Drive::step(const Panel& panel, bool stalled, bool overloaded, double dt_s) noexcept {
  silent_s_ += dt_s;
  if ((enabled_ || rotary_on_) && silent_s_ >= kWatchdog_s - kNearly_s) fail(RigFault::watchdog);
  if (enabled_ && stalled) fail(RigFault::stalled);
  if (enabled_ && overloaded) fail(RigFault::sensor);
  if (panel.drive_error) fail(RigFault::drive);
  if (panel.stop_pressed) {
    emergency_ = true;
    fail(RigFault::emergency);
  }
  const bool reset = panel.reset_pressed && !reset_was_pressed_;
  reset_was_pressed_ = panel.reset_pressed;
  if (reset && emergency_ && !panel.stop_pressed) {
    emergency_ = false;
    fault_ = RigFault::none;
  }
}

}  // namespace rig
}  // namespace tractus
