#include "station/loop/probing_guard.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::loop {
namespace {
namespace registers = devices::rig;
}

core::Json RigLimits::to_json() const {
  return {{"max_push_N", max_push_N},
          {"max_speed_m_s", max_speed_m_s},
          {"max_torque_Nm", max_torque_Nm}};
}

ProbingGuard::ProbingGuard(const RigLimits& limits, double travel_m, double period_s)
    : travel_m_(travel_m),
      period_s_(period_s),
      // At once when the drive is ready: the stage starts from standstill by its law. Silence is
      // counted in whole periods: half a one less than the limit tells the last of them.
      machine_({.quiet_ticks = 1,
                .ramp_ns = 0,
                .stale_latch_ns = core::Instant_ns(1e9 * (kSilent_s - 0.5 * period_s)),
                .when_stale = safety::Fault::silent}) {
  const RigLimits ceiling;
  const auto lower = [](double asked, double most) {
    return asked >= 0.0 ? std::min(asked, most) : 0.0;
  };
  limits_ = {lower(limits.max_push_N, ceiling.max_push_N),
             lower(limits.max_speed_m_s, ceiling.max_speed_m_s),
             lower(limits.max_torque_Nm, ceiling.max_torque_Nm)};
  machine_.arm();
}

// Of the machine's own. Its watchdog's is none yet: the drive is not ready.
safety::Fault ProbingGuard::fault_of(const devices::RigReading& r) noexcept {
  stopped_itself_ = false;
  if (r.status & registers::kEmergency) return safety::Fault::emergency;
  if (!(r.status & registers::kFaulted)) return safety::Fault::none;
  switch (r.fault) {
    case registers::RigFault::watchdog:
      stopped_itself_ = true;
      if (enabled() && ++restarts_ > kMostRestarts) return safety::Fault::watchdog;
      return safety::Fault::none;
    case registers::RigFault::stalled:
      return safety::Fault::stalled;
    case registers::RigFault::sensor:
      return safety::Fault::sensor;
    case registers::RigFault::emergency:
      return safety::Fault::emergency;
    case registers::RigFault::drive:
    case registers::RigFault::none:
      return safety::Fault::drive;
  }
  return safety::Fault::drive;
}

safety::Fault ProbingGuard::fault_of(devices::Exchange how) const noexcept {
  if (how == devices::Exchange::garbage) return safety::Fault::garbage;
  return how == devices::Exchange::gone ? safety::Fault::gone : safety::Fault::none;
}

safety::Fault ProbingGuard::tare(const devices::RigReading& r) noexcept {
  ++tared_;
  tare_N_ += (r.fz_N - tare_N_) / tared_;
  tare_Nm_ += (r.tz_Nm - tare_Nm_) / tared_;
  if (tared_ * period_s_ < kTare_s) return safety::Fault::none;
  if (std::abs(tare_N_) > kTareMost_N) return safety::Fault::hand_on;
  tare_known_ = true;
  return safety::Fault::none;
}

/// In a pause, and after it until the hand lets go.
bool ProbingGuard::held_back() noexcept {
  if (pause_.on())
    after_pause_ = true;
  else if (fresh_ && std::abs(last_.fz_N - tare_N_) < kTareMost_N)
    after_pause_ = false;
  return after_pause_;
}

ProbingGuard::LawInput ProbingGuard::see(devices::Exchange how,
                                         const devices::RigReading& reading) noexcept {
  fresh_ = how == devices::Exchange::ok;
  safety::Fault fault = fault_of(how);
  if (fresh_) {
    last_ = reading;
    fault = fault_of(reading);
    if (!tare_known_ && fault == safety::Fault::none && !latched()) fault = tare(reading);
  }
  share_ = machine_.tick(
      core::Instant_ns(1e9 * period_s_),
      {.fault = fault, .fresh = fresh_, .ready = tare_known_ && !stopped_itself_ && !held_back()});
  if (!fresh_) return {};
  return {.fz_N = tare_known_ ? reading.fz_N - tare_N_ : 0.0,
          .tz_Nm = tare_known_ ? reading.tz_Nm - tare_Nm_ : 0.0,
          .fresh = true};
}

bool ProbingGuard::held_by_push() noexcept {
  const bool held = std::abs(last_.fz_N - tare_N_) > std::min(limits_.max_push_N, cap_N_.value());
  pushed_s_ = held ? pushed_s_ + period_s_ : 0.0;
  if (pushed_s_ >= kPushed_s) machine_.fail(safety::Fault::pushed);
  return held;
}

double ProbingGuard::within_travel(double speed_m_s) const noexcept {
  const double ahead = std::max(0.0, travel_m_ - last_.x_m) / kApproach_s;
  const double behind = std::max(0.0, last_.x_m) / kApproach_s;
  return std::clamp(speed_m_s, -behind, ahead);
}

ProbingGuard::Passed ProbingGuard::pass(double speed_m_s, double torque_Nm) noexcept {
  if (latched() || !tare_known_) return {};
  if (!fresh_) {  // stand still; the drive stays on if its own watchdog lets it
    const bool on = enabled();
    return {.command = {.enable = on, .rotary_on = on}, .limited = speed_m_s != 0.0};
  }
  if (!enabled()) {
    reset_edge_ = stopped_itself_ && !reset_edge_;  // acts on its rising edge; one may be lost
    return {.command = {.reset_fault = reset_edge_}};
  }
  reset_edge_ = false;
  devices::RigCommand out{.enable = true, .rotary_on = true};
  if (share_ == 0.0) return {.command = out};  // not with the first command, which enables
  const bool held = held_by_push();
  if (latched()) return {};
  const double speed = std::isfinite(speed_m_s) && !held ? share_ * speed_m_s : 0.0;
  const double torque = std::isfinite(torque_Nm) ? share_ * torque_Nm : 0.0;
  out.speed_m_s = within_travel(std::clamp(speed, -limits_.max_speed_m_s, limits_.max_speed_m_s));
  out.torque_Nm = std::clamp(torque, -limits_.max_torque_Nm, limits_.max_torque_Nm);
  const bool limited = out.speed_m_s != speed_m_s || out.torque_Nm != torque_Nm;
  return {.command = out, .limited = limited};
}

}  // namespace tractus::loop
