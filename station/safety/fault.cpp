#include "station/safety/fault.hpp"

#include <array>

namespace tractus::safety {

const char* text_of(Fault fault) noexcept {
  static constexpr std::array<const char*, kFaults> kTexts{
      "no fault",
      "a pose or a force was not a finite number",
      "the device's pose jumped",
      "the handle moved faster than allowed",
      "the device gave no fresh sample for 20 ms",
      "the device reported a fault",
      "the device was unplugged: plug it in again and start anew",
      "the device took its forces away itself (button, velocity guard or watchdog): start anew",
      "the rig did not answer in time: it has stopped by itself; look at the cable",
      "the rig answered with something that is no answer: stopped",
      "the line to the rig was closed: it has stopped by itself",
      "emergency stop: release the button and press reset at the rig",
      "the push was above what the actuator can hold: stopped",
      "the rig's drive reports an error of its own: stopped",
      "the rig's force sensor is beyond its range: stopped",
      "this computer was held up again and again, and the rig stopped each time",
      "the push stayed above its limit: stopped",
      "somebody pushed the probe while its sensor was tared: let go of it at the start"};
  return kTexts[static_cast<std::size_t>(fault)];
}

}  // namespace tractus::safety
