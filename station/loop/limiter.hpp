/// The one way a force leaves for a hand.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/json.hpp"
#include "station/devices/device.hpp"
#include "station/loop/decreasing_limit.hpp"
#include "station/loop/pause.hpp"
#include "station/safety/machine.hpp"

namespace tractus::loop {

/// How much a hand may be given. Local alone: defaults, or the station's own file. A limit from a
/// server or a case can only lower (`lowered_by`); nothing raises above kCeiling.
struct HandLimits {
  double max_force_N = 10.0;  ///< magnitude
  double max_torque_Nm = 0.2;
  double max_force_slew_N_per_s = 2000.0;  ///< magnitude of change
  double max_torque_slew_Nm_per_s = 40.0;
  double max_speed_m_s = 2.0;  ///< velocity guard: faster latches
  double max_turn_rad_s = 40.0;
  double max_jump_m = 0.005;  ///< between two ticks, beyond what max_speed explains
  double ramp_s = 1.0;        ///< from nothing to all, after arming

  static const HandLimits kCeiling;
  /// Each limit the smaller of both (the ramp the longer); NaN and negatives count as zero.
  HandLimits lowered_by(const HandLimits& other) const noexcept;
  /// Fields by name, the missing ones from `fallback`. Errors: bad_input naming the field (above
  /// the ceiling too).
  static core::Result<HandLimits> from_json(const core::Json& json, const std::string& where);
  core::Json to_json() const;
};

using Guard = safety::State;
using safety::Fault;
using safety::text_of;

/// Of what a device answered: `none` for one that is fine or only late.
Fault fault_of(devices::Status status) noexcept;

/// Between model and device, axes of D. What is wrong it finds here; what follows from it, safety::
/// Machine decides. Guarantees, whatever comes in: |force| and |torque| never above the limits;
/// their change per second never above the slew, but for the fall to zero by a fault, which is at
/// once; zero from the tick in which a fault is seen; no way from `latched` or `off` but `arm`. A
/// stale sample gives zero in that tick; stale for kStaleLatch_ns latches.
class Limiter {
 public:
  static constexpr core::Instant_ns kStaleAfter_ns = 5'000'000;
  static constexpr core::Instant_ns kStaleLatch_ns = 20'000'000;
  static constexpr double kQuiet_N = 0.2;  ///< wanted force below which the ramp may begin
  static constexpr int kQuietTicks = 20;

  Limiter(const HandLimits& limits, core::Instant_ns period);
  /// An operator's deed: clears a fault, starts from zero.
  void arm() noexcept;
  void disarm() noexcept { machine_.disarm(); }
  /// Latches for a reason that another part saw (a device that refuses a command).
  void fail(Fault fault) noexcept { machine_.fail(fault); }
  /// Lowers from now on; cannot raise.
  void lower(const HandLimits& other) noexcept {
    limits_ = limits_.lowered_by(other);
    machine_.lengthen_ramp(static_cast<core::Instant_ns>(limits_.ramp_s * 1e9));
  }
  /// From any thread, while ticks run: no more force than this from the next tick on. A second call
  /// that asks for more changes nothing.
  void cap_force(double force_N) noexcept { cap_N_.lower(force_N); }
  /// From any thread, while ticks run: force and torque go to zero at the slew rate and stay there;
  /// without the pause they come back as after arming, through a quiet moment and the ramp.
  void pause(bool on) noexcept { pause_.set(on); }
  /// A pause is asked for, and nothing leaves any more.
  bool paused() const noexcept {
    return pause_.on() && last_.force_N.isZero(0.0) && last_.torque_Nm.isZero(0.0);
  }

  struct Passed {
    math::Wrench wrench;
    bool limited = false;  ///< differs from what was wanted
    bool stale = false;
  };
  /// One tick; real-time safe. @param wanted  on the handle, axes of D.
  Passed pass(core::Instant_ns now, devices::Status status, const devices::Sample& sample,
              const math::Wrench& wanted) noexcept;

  Guard guard() const noexcept { return machine_.state(); }
  Fault fault() const noexcept { return machine_.fault(); }
  const HandLimits& limits() const noexcept { return limits_; }

 private:
  Fault inspect(core::Instant_ns now, devices::Status status, const devices::Sample& sample,
                const math::Wrench& wanted) const noexcept;
  static bool is_stale(core::Instant_ns now, devices::Status status,
                       const devices::Sample& sample) noexcept;

  HandLimits limits_;
  DecreasingLimit cap_N_;
  PauseSwitch pause_;
  core::Instant_ns period_;
  safety::Machine machine_;
  math::Wrench last_;
  math::Vec3 last_p_ = math::Vec3::Zero();
  bool has_pose_ = false;
  core::Instant_ns last_tick_ = 0, last_fresh_ = 0;
  bool ticked_ = false;
};

}  // namespace tractus::loop
