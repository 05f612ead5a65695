/// A haptic device put to the question, with forces of a newton.
#pragma once

#include <functional>
#include <vector>

#include "station/check/durations.hpp"
#include "station/check/findings.hpp"
#include "station/devices/device.hpp"
#include "station/loop/limiter.hpp"

namespace tractus::check {

/// What is expected. Plausible bounds of ours, wide enough for any hand on the handle.
struct DeviceGoals {
  double travel_m = 0.10;  ///< in each direction, while somebody moves it about
  double rest_m = 0.003;   ///< most drift in a second at zero force
  double push_N = 1.0;     ///< of the directions' and the step's test
  double turn_Nm = 0.03;
  double least_way_m = 0.0005;  ///< that a push must move the handle along its axis
  double least_turn_rad = 0.001;
  double response_s = 0.05;  ///< from a step of force to a tenth of its way, at most
  double rise_s = 0.3;       ///< from a tenth to nine tenths, at most
  double overshoot = 0.5;    ///< beyond where it comes to rest, share of the way, at most
};

/// The parts that a check drives: tick by tick, as the haptic loop does.
struct Bench {
  core::Clock& clock;  ///< paces the ticks
  core::Clock& wall;   ///< times what the device takes
  devices::Device& device;
  loop::Limiter& limiter;  ///< armed here, disarmed at the end
  double rate_Hz = 4000.0;
  /// About thirty times a second, from the thread that ticks; false asks to stop.
  std::function<bool(double share)> progress = {};
};

/// While a hand moves the handle about for `for_s` seconds: the least range of the three
/// directions. No force. Errors: unavailable (the device's fault), cancelled.
core::Result<void> check_travel(Bench bench, const DeviceGoals& goals, double for_s,
                                std::vector<Finding>& out);

/// With the handle held loosely: rest at zero force, the direction of each of the six axes, the
/// response to a step, and how long a read and a write took meanwhile. What was found before an
/// error is in `out`. The device is left at zero force. Errors: unavailable (the device's fault),
/// cancelled.
core::Result<void> check_forces(Bench bench, const DeviceGoals& goals, std::vector<Finding>& out);

}  // namespace tractus::check
