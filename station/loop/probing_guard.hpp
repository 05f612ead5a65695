/// What stands between the law and the probing rig's drives: safety.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/json.hpp"
#include "station/devices/rig_device.hpp"
#include "station/loop/decreasing_limit.hpp"
#include "station/loop/pause.hpp"
#include "station/safety/machine.hpp"

namespace tractus::loop {

/// How much a hand on the probing rig may meet. Nothing raises above the defaults.
struct RigLimits {
  double max_push_N = 180.0;    ///< of the hand: above it the stage stands still
  double max_speed_m_s = 0.23;  ///< of the stage, by command
  double max_torque_Nm = 0.5;   ///< of the rotary motor, by command

  core::Json to_json() const;
};

using safety::text_of;

/// Gives every tick's command. It finds what is wrong and speaks the drive's language (enable,
/// reset); whether anything may move, safety::Machine decides. Armed when it is made: one is made
/// for each trial, which a person began. Guarantees, whatever comes in:
///
/// - nothing moves before it was enabled: a fresh answer without fault or e-stop, the sensor tared
///   over kTare_s with no hand on the probe;
/// - a speed within the limit, within the travel (slower towards either end: v <= left /
/// kApproach_s)
///   and 0 while |push| is above its limit, while there is no fresh answer, and after a fault;
/// - a fault latches: the command is "off" from that tick on. The e-stop is one; the machine
/// latches
///   it too, and only a person at its panel resets it.
///
/// When the bus is silent no command arrives either, and the machine stops by its own watchdog
/// within 10 ms. Such a stop (the machine's watchdog fault) is cleared and the drive enabled anew
/// when the bus is back, at most kMostRestarts times: a held-up computer is no danger, only a
/// flaw in the trial, which says so.
class ProbingGuard {
 public:
  static constexpr double kTare_s = 0.2, kTareMost_N = 10.0;
  static constexpr double kSilent_s = 0.05, kPushed_s = 0.5, kApproach_s = 0.01;
  static constexpr double kStill_m_s = 1e-4;
  static constexpr int kMostRestarts = 100;

  /// What the law is given to see, and what it wanted with it.
  struct LawInput {
    double fz_N = 0.0, tz_Nm = 0.0;  ///< tared
    bool fresh = false;              ///< the law may be stepped
  };
  struct Passed {
    devices::RigCommand command;
    bool limited = false;
  };

  /// @param travel_m  the probe stop of the scenario
  ProbingGuard(const RigLimits& limits, double travel_m, double period_s);

  /// First in the tick: judges what the exchange gave.
  LawInput see(devices::Exchange how, const devices::RigReading& reading) noexcept;
  /// Last in the tick: what goes out with the next exchange.
  Passed pass(double speed_m_s, double torque_Nm) noexcept;

  /// From any thread, while ticks run: the stage stands still above this push from the next tick
  /// on. A second call that asks for more changes nothing.
  void cap_push(double push_N) noexcept { cap_N_.lower(push_N); }

  /// From any thread, while ticks run: the drive is switched off. Without the pause it is enabled
  /// anew once the hand pushes with less than kTareMost_N.
  void pause(bool on) noexcept { pause_.set(on); }
  /// A pause is asked for, the drive is off, and the stage stands still.
  bool paused() const noexcept {
    return pause_.on() && !enabled() && std::abs(last_.speed_m_s) < kStill_m_s;
  }

  safety::State state() const noexcept { return machine_.state(); }
  bool latched() const noexcept { return state() == safety::State::latched; }
  safety::Fault fault() const noexcept { return machine_.fault(); }
  /// The drive is told to be on.
  bool enabled() const noexcept {
    return state() == safety::State::ramping || state() == safety::State::on;
  }
  int restarts() const noexcept { return restarts_; }  ///< after stops by the machine's watchdog
  double tare_N() const noexcept { return tare_N_; }
  double tare_Nm() const noexcept { return tare_Nm_; }

 private:
  safety::Fault fault_of(const devices::RigReading& reading) noexcept;
  safety::Fault fault_of(devices::Exchange how) const noexcept;
  safety::Fault tare(const devices::RigReading& reading) noexcept;
  bool held_by_push() noexcept;
  double within_travel(double speed_m_s) const noexcept;
  bool held_back() noexcept;

  RigLimits limits_;
  DecreasingLimit cap_N_;
  PauseSwitch pause_;
  double travel_m_, period_s_;
  safety::Machine machine_;
  devices::RigReading last_;
  bool fresh_ = false, tare_known_ = false, stopped_itself_ = false, reset_edge_ = false,
       after_pause_ = false;
  double share_ = 0.0, pushed_s_ = 0.0;
  double tare_N_ = 0.0, tare_Nm_ = 0.0;
  int tared_ = 0, restarts_ = 0;
};

}  // namespace tractus::loop
