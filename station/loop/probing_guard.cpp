#include "station/loop/probing_guard.hpp"

#include <algorithm>
#include <cmath>

namespace loop {
namespace {
namespace registers = devices::rig;
}

core::Json RigLimits::to_json() const {
  return {{"max_push_N", max_push_N},
          {"max_speed_m_s", max_speed_m_s},
          {"max_torque_Nm", max_torque_Nm}};
}

const char* text_of(RigFault fault) noexcept {
  switch (fault) {
    case RigFault::none:
      return "none";
    case RigFault::silent:
      return "the rig did not answer in time: it has stopped by itself; look at the cable";
    case RigFault::garbage:
      return "the rig answered with something that is no answer: stopped";
    case RigFault::gone:
      return "the line to the rig was closed: it has stopped by itself";
    case RigFault::emergency:
      return "emergency stop: release the button and press reset at the rig";
    case RigFault::stalled:
      return "the push was above what the actuator can hold: stopped";
    case RigFault::drive:
      return "the rig's drive reports an error of its own: stopped";
    case RigFault::sensor:
      return "the rig's force sensor is beyond its range: stopped";
    case RigFault::watchdog:
      return "this computer was held up again and again, and the rig stopped each time";
    case RigFault::pushed:
      return "the push stayed above its limit: stopped";
    case RigFault::hand_on:
      return "somebody pushed the probe while its sensor was tared: let go of it at the start";
  }
  return "an unknown fault";
}

ProbingGuard::ProbingGuard(const RigLimits& limits, double travel_m, double period_s)
    : travel_m_(travel_m), period_s_(period_s) {
  const RigLimits ceiling;
  const auto lower = [](double asked, double most) {
    return asked >= 0.0 ? std::min(asked, most) : 0.0;
  };
  limits_ = {lower(limits.max_push_N, ceiling.max_push_N),
             lower(limits.max_speed_m_s, ceiling.max_speed_m_s),
             lower(limits.max_torque_Nm, ceiling.max_torque_Nm)};
}

void ProbingGuard::fail(RigFault fault) noexcept {
  if (fault_ == RigFault::none) fault_ = fault;
}

void ProbingGuard::judge_fault(const devices::RigReading& r) noexcept {
  if (r.status & registers::kEmergency) return fail(RigFault::emergency);
  if (!(r.status & registers::kFaulted)) {
    if (phase_ == Phase::resetting) phase_ = Phase::enabling;
    return;
  }
  switch (r.fault) {
    case registers::Fault::watchdog:
      if (phase_ == Phase::enabled && ++restarts_ > kMostRestarts) return fail(RigFault::watchdog);
      if (phase_ == Phase::enabled || phase_ == Phase::enabling) phase_ = Phase::resetting;
      return;
    case registers::Fault::stalled:
      return fail(RigFault::stalled);
    case registers::Fault::sensor:
      return fail(RigFault::sensor);
    case registers::Fault::emergency:
      return fail(RigFault::emergency);
    case registers::Fault::drive:
    case registers::Fault::none:
      return fail(RigFault::drive);
  }
}

void ProbingGuard::tare(const devices::RigReading& r) noexcept {
  ++tared_;
  tare_N_ += (r.fz_N - tare_N_) / tared_;
  tare_Nm_ += (r.tz_Nm - tare_Nm_) / tared_;
  if (tared_ * period_s_ < kTare_s) return;
  if (std::abs(tare_N_) > kTareMost_N) return fail(RigFault::hand_on);
  phase_ = Phase::enabling;
}

ProbingGuard::Seen ProbingGuard::see(devices::Exchange how,
                                     const devices::RigReading& reading) noexcept {
  fresh_ = how == devices::Exchange::ok;
  if (!fresh_) {
    silent_s_ += period_s_;
    if (how == devices::Exchange::garbage) fail(RigFault::garbage);
    if (how == devices::Exchange::gone) fail(RigFault::gone);
    if (silent_s_ >= kSilent_s) fail(RigFault::silent);
    return {};
  }
  silent_s_ = 0.0;
  last_ = reading;
  judge_fault(reading);
  if (phase_ == Phase::taring && !latched()) tare(reading);
  const bool tared = phase_ != Phase::taring;
  return {.fz_N = tared ? reading.fz_N - tare_N_ : 0.0,
          .tz_Nm = tared ? reading.tz_Nm - tare_Nm_ : 0.0,
          .fresh = true};
}

bool ProbingGuard::held_by_push() noexcept {
  const bool held = std::abs(last_.fz_N - tare_N_) > limits_.max_push_N;
  pushed_s_ = held ? pushed_s_ + period_s_ : 0.0;
  if (pushed_s_ >= kPushed_s) fail(RigFault::pushed);
  return held;
}

double ProbingGuard::within_travel(double speed_m_s) const noexcept {
  const double ahead = std::max(0.0, travel_m_ - last_.x_m) / kApproach_s;
  const double behind = std::max(0.0, last_.x_m) / kApproach_s;
  return std::clamp(speed_m_s, -behind, ahead);
}

ProbingGuard::Passed ProbingGuard::pass(double speed_m_s, double torque_Nm) noexcept {
  if (latched() || phase_ == Phase::taring) return {};
  if (!fresh_) {  // stand still; the drive stays on if its own watchdog lets it
    const bool on = phase_ == Phase::enabled;
    return {.command = {.enable = on, .rotary_on = on}, .limited = speed_m_s != 0.0};
  }
  if (phase_ == Phase::resetting) {
    reset_edge_ = !reset_edge_;  // acts on its rising edge; one may be lost
    return {.command = {.reset_fault = reset_edge_}};
  }
  reset_edge_ = false;
  devices::RigCommand out{.enable = true, .rotary_on = true};
  const bool moves = phase_ == Phase::enabled;  // not with the first command, which enables
  phase_ = Phase::enabled;
  if (!moves) return {.command = out};
  const bool held = held_by_push();
  if (latched()) return {};
  const double speed = std::isfinite(speed_m_s) && !held ? speed_m_s : 0.0;
  const double torque = std::isfinite(torque_Nm) ? torque_Nm : 0.0;
  out.speed_m_s = within_travel(std::clamp(speed, -limits_.max_speed_m_s, limits_.max_speed_m_s));
  out.torque_Nm = std::clamp(torque, -limits_.max_torque_Nm, limits_.max_torque_Nm);
  const bool limited = out.speed_m_s != speed_m_s || out.torque_Nm != torque_Nm;
  return {.command = out, .limited = limited};
}

}  // namespace loop
