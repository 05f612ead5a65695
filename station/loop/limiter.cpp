#include "station/loop/limiter.hpp"

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace loop {
namespace {
using devices::Sample;
using devices::Status;
using math::Vec3;
using math::Wrench;

double lower_of(double a, double b) { return b > 0.0 ? std::min(a, b) : 0.0; }  // NaN > 0 is false

bool finite(const Wrench& wrench) {
  return wrench.force_N.allFinite() && wrench.torque_Nm.allFinite();
}

bool finite(const Sample& sample) {
  return sample.X_DH.p.allFinite() && sample.X_DH.q.coeffs().allFinite() &&
         sample.velocity_m_s.allFinite() && sample.angular_velocity_rad_s.allFinite() &&
         std::abs(sample.X_DH.q.squaredNorm() - 1.0) < 1e-3;
}

// At most `most` long. The product may round upwards: a hair less is asked for.
Vec3 clamped(const Vec3& v, double most) {
  const double length = v.norm();
  return length > most ? Vec3(v * (most / length * (1.0 - 1e-12))) : v;
}

Vec3 towards(const Vec3& from, const Vec3& to, double most) {
  const Vec3 change = to - from;
  return change.norm() > most ? Vec3(from + clamped(change, most)) : to;
}
}  // namespace

const HandLimits HandLimits::kCeiling{.max_force_N = 20.0,
                                      .max_torque_Nm = 0.4,
                                      .max_force_slew_N_per_s = 10000.0,
                                      .max_torque_slew_Nm_per_s = 200.0,
                                      .max_speed_m_s = 3.0,
                                      .max_turn_rad_s = 60.0,
                                      .max_jump_m = 0.01,
                                      .ramp_s = 0.2};

HandLimits HandLimits::lowered_by(const HandLimits& other) const noexcept {
  return {.max_force_N = lower_of(max_force_N, other.max_force_N),
          .max_torque_Nm = lower_of(max_torque_Nm, other.max_torque_Nm),
          .max_force_slew_N_per_s = lower_of(max_force_slew_N_per_s, other.max_force_slew_N_per_s),
          .max_torque_slew_Nm_per_s =
              lower_of(max_torque_slew_Nm_per_s, other.max_torque_slew_Nm_per_s),
          .max_speed_m_s = lower_of(max_speed_m_s, other.max_speed_m_s),
          .max_turn_rad_s = lower_of(max_turn_rad_s, other.max_turn_rad_s),
          .max_jump_m = lower_of(max_jump_m, other.max_jump_m),
          .ramp_s = other.ramp_s > ramp_s ? other.ramp_s : ramp_s};
}

core::Result<HandLimits> HandLimits::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  const HandLimits normal;
  HandLimits out;
  out.max_force_N = fields.number_or("max_force_N", normal.max_force_N, 0.0, kCeiling.max_force_N);
  out.max_torque_Nm =
      fields.number_or("max_torque_Nm", normal.max_torque_Nm, 0.0, kCeiling.max_torque_Nm);
  out.max_force_slew_N_per_s =
      fields.number_or("max_force_slew_N_per_s", normal.max_force_slew_N_per_s, 1.0,
                       kCeiling.max_force_slew_N_per_s);
  out.max_torque_slew_Nm_per_s =
      fields.number_or("max_torque_slew_Nm_per_s", normal.max_torque_slew_Nm_per_s, 0.1,
                       kCeiling.max_torque_slew_Nm_per_s);
  out.max_speed_m_s =
      fields.number_or("max_speed_m_s", normal.max_speed_m_s, 0.05, kCeiling.max_speed_m_s);
  out.max_turn_rad_s =
      fields.number_or("max_turn_rad_s", normal.max_turn_rad_s, 0.5, kCeiling.max_turn_rad_s);
  out.max_jump_m = fields.number_or("max_jump_m", normal.max_jump_m, 0.0005, kCeiling.max_jump_m);
  out.ramp_s = fields.number_or("ramp_s", normal.ramp_s, kCeiling.ramp_s, 30.0);
  TRY(fields.done());
  return out;
}

core::Json HandLimits::to_json() const {
  return {{"max_force_N", max_force_N},
          {"max_torque_Nm", max_torque_Nm},
          {"max_force_slew_N_per_s", max_force_slew_N_per_s},
          {"max_torque_slew_Nm_per_s", max_torque_slew_Nm_per_s},
          {"max_speed_m_s", max_speed_m_s},
          {"max_turn_rad_s", max_turn_rad_s},
          {"max_jump_m", max_jump_m},
          {"ramp_s", ramp_s}};
}

Fault fault_of(Status status) noexcept {
  switch (status) {
    case Status::ok:
    case Status::stale:
      return Fault::none;
    case Status::fault:
      return Fault::device;
    case Status::gone:
      return Fault::unplugged;
    case Status::forces_off:
      return Fault::forces_off;
  }
  return Fault::device;
}

Limiter::Limiter(const HandLimits& limits, core::Instant_ns period)
    : limits_(limits.lowered_by(HandLimits::kCeiling)),
      period_(period),
      machine_({.quiet_ticks = kQuietTicks,
                .ramp_ns = static_cast<core::Instant_ns>(limits_.ramp_s * 1e9),
                .stale_latch_ns = kStaleLatch_ns,
                .when_stale = Fault::stale}) {}

void Limiter::arm() noexcept {
  machine_.arm();
  last_ = {};
  has_pose_ = ticked_ = false;
}

// What is wrong for good in this tick; a stale sample alone is not yet.
Fault Limiter::inspect(core::Instant_ns now, Status status, const Sample& sample,
                       const Wrench& wanted) const noexcept {
  if (const Fault said = fault_of(status); said != Fault::none) return said;
  if (is_stale(now, status, sample)) return Fault::none;
  if (!finite(sample) || !finite(wanted)) return Fault::not_finite;
  if (sample.velocity_m_s.norm() > limits_.max_speed_m_s ||
      sample.angular_velocity_rad_s.norm() > limits_.max_turn_rad_s)
    return Fault::speed;
  const double since_s =
      static_cast<double>(std::max(now - last_fresh_ - period_, core::Instant_ns{0})) * 1e-9;
  const double explained_m = limits_.max_jump_m + limits_.max_speed_m_s * since_s;
  if (has_pose_ && (sample.X_DH.p - last_p_).norm() > explained_m) return Fault::jump;
  return Fault::none;
}

bool Limiter::is_stale(core::Instant_ns now, Status status, const Sample& sample) noexcept {
  return status != Status::ok || now - sample.stamp > kStaleAfter_ns;
}

Limiter::Passed Limiter::pass(core::Instant_ns now, Status status, const Sample& sample,
                              const Wrench& wanted) noexcept {
  if (!ticked_) last_fresh_ = last_tick_ = now - period_;
  const core::Instant_ns elapsed = std::max(now - last_tick_, core::Instant_ns{0});
  last_tick_ = now;
  ticked_ = true;

  Passed out;
  out.stale = is_stale(now, status, sample);
  const bool starts = machine_.state() == Guard::waiting;
  const double part = machine_.tick(
      elapsed, {.fault = inspect(now, status, sample, wanted),
                .fresh = !out.stale,
                .ready = !pause_.on() && (!starts || wanted.force_N.norm() < kQuiet_N)});
  if (out.stale || guard() == Guard::off || guard() == Guard::latched) {
    last_ = {};
    out.limited = !(wanted.force_N.isZero(0.0) && wanted.torque_Nm.isZero(0.0));
    return out;
  }
  last_fresh_ = now;
  last_p_ = sample.X_DH.p;
  has_pose_ = true;

  const double dt_s = static_cast<double>(std::min(elapsed, 2 * period_)) * 1e-9;
  const double max_N = std::min(limits_.max_force_N, cap_N_.value());
  const Vec3 force = clamped(part * wanted.force_N, max_N);
  const Vec3 torque = clamped(part * wanted.torque_Nm, limits_.max_torque_Nm);
  last_.force_N =
      clamped(towards(last_.force_N, force, limits_.max_force_slew_N_per_s * dt_s), max_N);
  last_.torque_Nm =
      clamped(towards(last_.torque_Nm, torque, limits_.max_torque_slew_Nm_per_s * dt_s),
              limits_.max_torque_Nm);
  out.wrench = last_;
  out.limited = last_.force_N != wanted.force_N || last_.torque_Nm != wanted.torque_Nm;
  return out;
}

}  // namespace loop
}  // namespace tractus
