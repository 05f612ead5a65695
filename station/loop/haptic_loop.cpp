#include "station/loop/haptic_loop.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace loop {
namespace {
using devices::Status;
using math::Vec3;

std::array<double, 3> array_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
std::array<float, 3> floats_of(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
std::array<double, 4> array_of(const math::Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

/// What of a step may be recorded: what no trial may hold becomes zero (the limiter has latched or
/// clamped by then).
Vec3 recordable(const Vec3& v) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() < trial::kMaxMagnitude ? v : Vec3::Zero();
}
bool plausible(const math::Pose& pose) {
  return pose.p.allFinite() && pose.p.cwiseAbs().maxCoeff() < 100.0 &&
         std::abs(pose.q.squaredNorm() - 1.0) < 1e-3;  // NaN compares false
}
}  // namespace

HapticLoop::HapticLoop(Parts parts, const math::Pose& X_VD, const Vec3& pose_offset_m,
                       double rate_Hz)
    : parts_(parts), X_VD_(X_VD), pose_offset_m_(pose_offset_m), periods_(parts.clock, rate_Hz) {
  core::require(rate_Hz >= 100.0 && rate_Hz <= 20000.0, "a loop runs at 100 … 20000 Hz");
}

void HapticLoop::run(const std::function<void()>& each_tick) noexcept {
  periods_.run([this](const PeriodicLoop::Tick& at) { tick(at.now, at.number, at.late); },
               [&] {
                 if (each_tick) each_tick();
                 return parts_.limiter.guard() != Guard::latched;
               });
  static_cast<void>(
      parts_.device.write({}));  // a device that fails here is at zero by its own watchdog
}

void HapticLoop::tick(core::Instant_ns now, std::uint32_t number, bool late) noexcept {
  devices::Sample sample;
  const Status status = parts_.device.read(now, sample);
  const bool usable = status == Status::ok && plausible(sample.X_DH);
  if (usable) X_DH_ = sample.X_DH;  // else the last good pose stands, flagged
  const math::Pose X_VH = X_VD_ * X_DH_;
  const bool paused = parts_.limiter.paused();
  timeline_.tick(now, number, paused);
  const double t_s = timeline_.t_s(periods_.started());
  const std::uint32_t patches = parts_.tool && !paused ? parts_.tool->apply(t_s) : 0;
  laws::PalpationStep step;
  if (usable)
    step = parts_.contact.step({.X_VH = X_VH,
                                .v_m_s = X_VD_.q * sample.velocity_m_s,
                                .omega_rad_s = X_VD_.q * sample.angular_velocity_rad_s},
                               static_cast<double>(now) * 1e-9);

  const math::Quat& q_DH = X_DH_.q;
  const Limiter::Passed passed =
      parts_.limiter.pass(now, status, sample, wanted_of(step, sample, usable));
  const Status given = parts_.device.write(passed.wrench);
  if (const Fault fault = fault_of(given); fault != Fault::none) parts_.limiter.fail(fault);
  energy_.holds(passed.wrench);

  trial::Sample out;
  out.t_s = t_s;
  out.p_VH_m = array_of(X_VH.p);
  out.q_VH = array_of(X_VH.q);
  out.force_N = floats_of(recordable(step.wrench_H.force_N));
  out.torque_Nm = floats_of(recordable(step.wrench_H.torque_Nm));
  const Vec3 rendered_H = q_DH.conjugate() * passed.wrench.force_N;
  out.rendered_force_N = floats_of(rendered_H);
  out.rendered_torque_Nm = floats_of(q_DH.conjugate() * passed.wrench.torque_Nm);
  const bool bent = step.deflection_m.allFinite();
  out.deflection_m = {bent ? float(step.deflection_m.x()) : 0.0f,
                      bent ? float(step.deflection_m.y()) : 0.0f};
  out.tick = timeline_.number();
  out.iterations = static_cast<std::uint16_t>(std::clamp(step.iterations, 0, 65535));
  out.flags = static_cast<std::uint16_t>(
      (step.converged ? 0 : trial::kNotConverged) | (passed.limited ? trial::kLimited : 0) |
      (late ? trial::kLate : 0) | (passed.stale ? trial::kStale : 0) |
      (sample.saturated ? trial::kSaturated : 0) | (sample.buttons & 1u ? trial::kPressed : 0));
  out.patches = patches;
  if (!paused) {
    if (parts_.tool) parts_.tool->worked(out);
    periods_.count(out.flags, parts_.ring.push(out));
  }
  parts_.live.write(
      {.t_s = out.t_s,
       .p_VH_m = array_of(Vec3(X_VH.p + pose_offset_m_)),
       .q_VH = out.q_VH,
       .deflection_m = {out.deflection_m[0], out.deflection_m[1]},
       .rendered_force_N = array_of(rendered_H),
       .rendered_torque_Nm = array_of(Vec3(q_DH.conjugate() * passed.wrench.torque_Nm)),
       .tick = out.tick,
       .late_ticks = static_cast<std::uint32_t>(counts().late),
       .buttons = sample.buttons});
}

// The model's wrench in D, and the energy of the stretch that ends here.
math::Wrench HapticLoop::wanted_of(const laws::PalpationStep& step, const devices::Sample& sample,
                                   bool usable) noexcept {
  if (usable)
    energy_.moved_to(X_DH_);
  else
    energy_.lost_sight();
  const math::Wrench wanted_D{X_DH_.q * step.wrench_H.force_N, X_DH_.q * step.wrench_H.torque_Nm};
  if (parts_.passivity == Passivity::observed || !usable) return wanted_D;
  return safety::PassivityController::damped(wanted_D, energy_.given_J(), sample.velocity_m_s,
                                             sample.angular_velocity_rad_s,
                                             static_cast<double>(periods_.period()) * 1e-9);
}

}  // namespace loop
}  // namespace tractus
