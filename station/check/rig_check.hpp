/// The probing rig put to the question: its link, its sensor, a small travel, its watchdog.
#pragma once

#include <functional>
#include <vector>

#include "station/check/durations.hpp"
#include "station/check/findings.hpp"
#include "station/devices/rig_device.hpp"
#include "station/loop/probing_guard.hpp"

namespace tractus::check {

/// What is expected. The zero is the guard's own bound, the stop the machine's own promise; the
/// rest is plausible, and ours.
struct RigGoals {
  double lost_share = 0.001;                        ///< exchanges without an answer in time
  double zero_N = loop::ProbingGuard::kTareMost_N;  ///< of the sensor with nobody on the probe
  double zero_Nm = 0.1;
  double noise_N = 1.0;     ///< standard deviation
  double speed_m_s = 0.02;  ///< of the small travel
  double way_m = 0.01;
  double way_error_m = 0.0005;
  double rise_s = 0.03;     ///< of the speed, from a tenth to nine tenths
  double stop_s = 0.01;     ///< after the last command, by the machine's own watchdog
  double home_m = 0.0002;   ///< from the entry, after the return
  double turn_Nm = 0.02;    ///< pulse of the rotary motor, and one back
  double least_rad = 0.01;  ///< that it must turn
};

struct RigBench {
  core::Clock& clock;  ///< paces the exchanges
  core::Clock& wall;   ///< times them
  devices::RigDevice& device;
  loop::RigLimits limits = {};
  double travel_m = 0.1;
  double rate_Hz = 1000.0;
  /// About thirty times a second, from the thread that ticks; false asks to stop.
  std::function<bool(double share)> progress = {};
};

/// The drive is off, nothing moves, nobody touches the probe: answers lost and how long they took,
/// the e-stop, zero and noise of the sensor.
/// @returns whether it may be moved (it answers, no e-stop). Errors: unavailable, cancelled.
core::Result<bool> check_rig_at_rest(RigBench bench, const RigGoals& goals,
                                     std::vector<Finding>& out);

/// From the entry, through loop::ProbingGuard: a small travel in and the step of speed that begins
/// it, the machine's own watchdog, the way back, a turn of the rotary motor. What was found before
/// an error is in `out`. The drive is left off. Errors: unavailable (the rig's fault), cancelled.
core::Result<void> check_rig_motion(RigBench bench, const RigGoals& goals,
                                    std::vector<Finding>& out);

/// A person presses the e-stop and takes it back, each within `patience_s`; `tell` says when. The
/// drive is off. Errors: unavailable, cancelled.
core::Result<Finding> check_emergency_stop(RigBench bench, double patience_s,
                                           const std::function<void(const char*)>& tell);

}  // namespace tractus::check
