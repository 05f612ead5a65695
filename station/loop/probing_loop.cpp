#include "station/loop/probing_loop.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace loop {
namespace {
using devices::Exchange;
using trial::ProbingMode;
using trial::ProbingSample;

constexpr double kAtStop_m = 2e-5;
constexpr int kFarewells = 3;  // one would do, were none ever lost
}  // namespace

ProbingLoop::ProbingLoop(Parts parts, const models::ProbingRuntime& law, double travel_m,
                         double rate_Hz)
    : parts_(parts),
      law_(&law),
      travel_m_(travel_m),
      period_s_(1.0 / rate_Hz),
      periods_(parts.clock, rate_Hz) {
  core::require(rate_Hz >= 100.0 && rate_Hz <= 1000.0, "the rig's loop runs at 100 … 1000 Hz");
}

void ProbingLoop::run(const std::function<void(const ProbingSample&)>& each_tick) noexcept {
  ProbingSample sample;
  periods_.run(
      [&](const PeriodicLoop::Tick& at) {
        sample = tick(at.now, at.number, at.late);
        record(sample, at.deadline);
        if (stopped_s_ >= kStopped_s) stop();
      },
      [&] {
        if (each_tick) each_tick(sample);
        return !parts_.guard.latched();
      });
  for (int k = 0; k < kFarewells; ++k)
    if (parts_.device.exchange({}, reading_) == Exchange::gone) break;
}

void ProbingLoop::follow_angle(std::int32_t angle_urad) noexcept {
  if (angle_known_)  // the register wraps; the difference does not
    theta_rad_ += 1e-6 * static_cast<std::int32_t>(static_cast<std::uint32_t>(angle_urad) -
                                                   static_cast<std::uint32_t>(last_urad_));
  last_urad_ = angle_urad;
  angle_known_ = true;
}

// Trapezoid between two fresh answers: neither force nor motion is held here, both are measured.
void ProbingLoop::follow_energy(double push_N) noexcept {
  if (angle_known_) given_J_ -= 0.5 * (push_N + last_push_N_) * (reading_.x_m - last_x_m_);
  injected_J_ = std::max(injected_J_, given_J_);
  last_push_N_ = push_N;
  last_x_m_ = reading_.x_m;
}

void ProbingLoop::step_law(const ProbingGuard::LawInput& seen, ProbingSample& out,
                           double& torque_Nm) noexcept {
  const models::ProbingRuntime& law = *law_.load(std::memory_order_acquire);
  const double x_m = std::clamp(reading_.x_m, 0.0, travel_m_);
  at_.at.x_m = x_m;
  out.law_m_s = float(law.advance(seen.fz_N, reading_.turning_rad_s, period_s_, at_));
  // Of the depth that was read, not of the one a period ahead.
  const bool holds = at_.at.mode == ProbingMode::holding;
  out.mode = x_m >= travel_m_ - kAtStop_m ? ProbingMode::stopped
             : holds                      ? ProbingMode::holding
                                          : law.law().mode_at(x_m);
  torque_Nm = -law.torque_Nm(x_m, theta_rad_, reading_.turning_rad_s);
}

ProbingSample ProbingLoop::tick(core::Instant_ns now, std::uint32_t number, bool late) noexcept {
  const core::Instant_ns asked = parts_.wall.now();
  const Exchange how = parts_.device.exchange(command_, reading_);
  const core::Instant_ns round_trip = parts_.wall.now() - asked;
  const ProbingGuard::LawInput seen = parts_.guard.see(how, reading_);
  paused_ = parts_.guard.paused();
  timeline_.tick(now, number, paused_);
  ProbingSample out;
  double torque_Nm = 0.0;
  if (seen.fresh) {
    follow_energy(seen.fz_N);
    follow_angle(reading_.angle_urad);
    step_law(seen, out, torque_Nm);
    round_trip_.add(round_trip);
    out.round_trip_s = float(1e-9 * double(round_trip));
  }
  const ProbingGuard::Passed passed = parts_.guard.pass(double(out.law_m_s), torque_Nm);
  command_ = passed.command;
  if (out.mode != ProbingMode::stopped && !parts_.guard.enabled()) out.mode = ProbingMode::holding;
  if (!paused_) stopped_s_ = out.mode == ProbingMode::stopped ? stopped_s_ + period_s_ : 0.0;
  out.t_s = timeline_.t_s(periods_.started());
  out.x_m = reading_.x_m;
  out.theta_rad = theta_rad_;
  out.speed_m_s = float(reading_.speed_m_s);
  out.turning_rad_s = float(reading_.turning_rad_s);
  out.fz_N = float(reading_.fz_N - parts_.guard.tare_N());
  out.tz_Nm = float(reading_.tz_Nm - parts_.guard.tare_Nm());
  out.command_m_s = float(command_.speed_m_s);
  out.command_Nm = float(command_.torque_Nm);
  out.tick = timeline_.number();
  out.fault = std::uint8_t(reading_.fault);
  out.flags = static_cast<std::uint16_t>((passed.limited ? trial::kLimited : 0) |
                                         (late ? trial::kLate : 0) |
                                         (seen.fresh ? 0 : trial::kStale | trial::kBusLost));
  return out;
}

void ProbingLoop::record(ProbingSample& sample, core::Instant_ns deadline) noexcept {
  if (parts_.clock.now() > deadline + periods_.period()) sample.flags |= trial::kMissed;
  if (!paused_) periods_.count(sample.flags, parts_.ring.push(sample));
  const trial::TickCounts& n = counts();
  parts_.live.write({.t_s = sample.t_s,
                     .x_m = sample.x_m,
                     .speed_m_s = double(sample.speed_m_s),
                     .fz_N = double(sample.fz_N),
                     .turning_rad_s = double(sample.turning_rad_s),
                     .missed = n.missed + n.bus_lost + n.skipped,
                     .tick = sample.tick,
                     .mode = sample.mode});
}

}  // namespace loop
}  // namespace tractus
