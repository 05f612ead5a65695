#include "station/loop/program_player.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus {
namespace loop {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using trial::MotionProgram;
using trial::ProbingMeasurement;

constexpr int kLastCommands = 3;  // one would do, were none ever lost

MotionProgram approach(const MotionProgram& program, double from_m) {
  MotionProgram out;
  out.start_m = from_m;
  out.start_rad = program.start_rad;
  out.acceleration_m_s2 = program.acceleration_m_s2;
  out.moves = {{program.start_m, ProgramPlayer::kApproach_m_s, program.start_rad, 1.0, 0.5}};
  return out;
}

}  // namespace

ProgramPlayer::ProgramPlayer(Parts parts, double rate_Hz) : parts_(parts), rate_Hz_(rate_Hz) {}

std::vector<ProgramPlayer::Moment> ProgramPlayer::schedule(const MotionProgram& program,
                                                           int repetitions) const {
  std::vector<Moment> out;
  const auto add = [&](const MotionProgram& part, int trial) {
    const auto motion = part.motion(1.0 / rate_Hz_);
    for (std::size_t i = 0; i < motion.size(); ++i)
      out.push_back(
          {motion.x_m[i], motion.v_m_s[i], motion.theta_rad[i], motion.omega_rad_s[i], trial});
  };
  for (int k = 0; k < repetitions; ++k) {
    add(approach(program, k == 0 ? 0.0 : program.moves.back().to_m), -1);
    add(program, k);
  }
  return out;
}

void ProgramPlayer::follow_angle(std::int32_t angle_urad) noexcept {
  if (angle_known_)  // the register wraps; the difference does not
    theta_rad_ += 1e-6 * static_cast<std::int32_t>(static_cast<std::uint32_t>(angle_urad) -
                                                   static_cast<std::uint32_t>(last_urad_));
  last_urad_ = angle_urad;
  angle_known_ = true;
}

Result<std::vector<ProbingMeasurement>> ProgramPlayer::play(const MotionProgram& program,
                                                            int repetitions, Playing& playing) {
  const auto moments = schedule(program, repetitions);
  std::vector<ProbingMeasurement> out(static_cast<std::size_t>(repetitions));
  const std::size_t longest = std::size_t(program.seconds() * rate_Hz_) + 2;
  for (std::size_t k = 0; k < out.size(); ++k) {
    ProbingMeasurement& trial = out[k];
    trial.id = trial.file = fmt::format("{}-{}", program.name, k + 1);
    for (auto* column : {&trial.t_s, &trial.x_m, &trial.theta_rad, &trial.fz_N, &trial.tz_Nm})
      column->reserve(longest);
  }
  PeriodicLoop periods(parts_.clock, rate_Hz_);
  devices::RigReading reading;
  devices::RigCommand command;
  std::size_t at = 0;
  std::uint32_t last = 0;
  periods.run(
      [&](const PeriodicLoop::Tick& tick) {
        const auto seen = parts_.guard.see(parts_.device.exchange(command, reading), reading);
        if (seen.fresh) follow_angle(reading.angle_urad);
        const Moment& now = moments[std::min(at, moments.size() - 1)];
        if (seen.fresh && parts_.guard.enabled() && now.trial >= 0 && at < moments.size()) {
          ProbingMeasurement& trial = out[std::size_t(now.trial)];
          trial.t_s.push_back(1e-9 * double(tick.now - periods.started()));
          trial.x_m.push_back(reading.x_m);
          trial.theta_rad.push_back(theta_rad_);
          trial.fz_N.push_back(seen.fz_N);
          trial.tz_Nm.push_back(seen.tz_Nm);
        }
        const double speed = now.v_m_s + kFollow_per_s * (now.x_m - reading.x_m);
        const double torque = kTurnStiffness_Nm_per_rad * (now.theta_rad - theta_rad_) +
                              kTurnDamping_Nms_per_rad * (now.omega_rad_s - reading.turning_rad_s);
        command = parts_.guard.pass(speed, torque).command;
        if (parts_.guard.enabled())
          at += tick.number - last;  // skipped periods move the program on too
        last = tick.number;
      },
      [&] {
        playing.share = std::min(1.0, double(at) / double(moments.size()));
        return !playing.stop && !parts_.guard.latched() && at < moments.size();
      });
  for (int k = 0; k < kLastCommands; ++k)
    if (parts_.device.exchange({}, reading) == devices::Exchange::gone) break;
  if (playing.stop && at < moments.size()) return Error{Errc::cancelled, "stopped"};
  if (parts_.guard.latched())
    return Error{Errc::unavailable,
                 fmt::format("the rig stopped while it played: {}", text_of(parts_.guard.fault()))};
  for (ProbingMeasurement& trial : out) {
    const double first = trial.t_s.empty() ? 0.0 : trial.t_s.front();
    for (double& t : trial.t_s) t -= first;
  }
  return out;
}

}  // namespace loop
}  // namespace tractus
