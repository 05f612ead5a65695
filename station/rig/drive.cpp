#include "station/rig/drive.hpp"

namespace rig {

namespace {
constexpr double kWatchdog_s = 1e-3 * devices::rig::kWatchdog_ms;
constexpr double kNearly_s = 1e-9;  // sums of steps are not exact
}  // namespace

void Drive::fail(Fault fault) noexcept {
  enabled_ = false;
  rotary_on_ = false;
  if (fault_ == Fault::none || fault == Fault::emergency) fault_ = fault;
}

void Drive::command(std::uint16_t control) noexcept {
  const std::uint16_t rising = control & static_cast<std::uint16_t>(~control_);
  control_ = control;
  silent_s_ = 0.0;
  if ((rising & devices::rig::kResetFault) && !emergency_) fault_ = Fault::none;
  const bool healthy = fault_ == Fault::none && !emergency_;
  if (!(control & devices::rig::kEnable)) enabled_ = false;
  if ((rising & devices::rig::kEnable) && healthy) enabled_ = true;
  rotary_on_ = healthy && (control & devices::rig::kRotaryOn);
}

void Drive::step(const Panel& panel, bool stalled, bool overloaded, double dt_s) noexcept {
  silent_s_ += dt_s;
  if ((enabled_ || rotary_on_) && silent_s_ >= kWatchdog_s - kNearly_s) fail(Fault::watchdog);
  if (enabled_ && stalled) fail(Fault::stalled);
  if (enabled_ && overloaded) fail(Fault::sensor);
  if (panel.drive_error) fail(Fault::drive);
  if (panel.stop_pressed) {
    emergency_ = true;
    fail(Fault::emergency);
  }
  const bool reset = panel.reset_pressed && !reset_was_pressed_;
  reset_was_pressed_ = panel.reset_pressed;
  if (reset && emergency_ && !panel.stop_pressed) {
    emergency_ = false;
    fault_ = Fault::none;
  }
}

}  // namespace rig
