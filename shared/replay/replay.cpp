#include "replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "models/palpation_stream.hpp"

namespace tractus {
namespace replay {
namespace {

using core::Errc;
using core::Error;

constexpr double kMostSteps = 1e9;
constexpr std::size_t kSamplesPerWord = 256;  // between two words to the progress

/// Errors: as of replay.
core::Result<void> check_times(const trial::PalpationMeasurement& recording) {
  double steps = 1.0;
  for (std::size_t k = 1; k < recording.t_s.size(); ++k) {
    const double from = recording.t_s[k - 1], to = recording.t_s[k];
    if (to - from > models::kLongestGap_s)
      return Error{
          Errc::bad_input,
          fmt::format("{}: no sample between {} s and {} s; gaps of at most {} s are replayed",
                      recording.file, from, to, models::kLongestGap_s)};
    steps += double(models::palpation_steps(from, to));
  }
  if (steps > kMostSteps)
    return Error{Errc::bad_input,
                 fmt::format("{}: {:.3g} steps of {} Hz, at most {:.0g} are replayed",
                             recording.file, steps, models::kPalpationRate_Hz, kMostSteps)};
  return {};
}

}  // namespace

core::Result<Replayed> replay(const models::PalpationRuntime& runtime,
                              const trial::PalpationMeasurement& recording, const math::Vec3& down,
                              const core::Progress& progress) {
  TRY(check_times(recording));
  const auto motion = models::PalpationMotion::through(recording.t_s, recording.X_VH, down);
  if (!motion) return Error{motion.error().code, recording.file + ": " + motion.error().what};
  models::PalpationWalk walk(runtime);
  Replayed out;
  for (std::size_t k = 0; k < recording.t_s.size(); ++k) {
    const auto answer = walk.to(recording.t_s[k], *motion);
    out.wrench_H.push_back(answer.wrench_H);
    out.deflection_m.push_back(answer.deflection_m);
    out.converged.push_back(answer.converged);
    const auto then = models::between_samples(*motion, recording.t_s[k] - runtime.delay_s());
    out.samples_in_volume +=
        runtime.field().geometry().contains(runtime.tip_m(then.X_VH, answer.deflection_m));
    if (progress && k % kSamplesPerWord == kSamplesPerWord - 1 &&
        !progress(double(k) / double(recording.t_s.size())))
      return Error{Errc::cancelled, "the replay was stopped"};
  }
  out.steps = walk.steps();
  out.not_converged = walk.not_converged();
  return out;
}

std::string motion_csv(const models::PalpationMotion& motion) {
  std::string out =
      "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,omega_x_rad_s,omega_y_rad_s,"
      "omega_z_rad_s,ax_m_s2,ay_m_s2,az_m_s2,alpha_x_rad_s2,alpha_y_rad_s2,alpha_z_rad_s2\n";
  const auto cells = [](const math::Vec3& v) {
    return fmt::format("{},{},{}", v.x(), v.y(), v.z());
  };
  for (std::size_t k = 0; k < motion.t_s.size(); ++k) {
    const auto& [X_VH, v_m_s, omega_rad_s, a_m_s2, alpha_rad_s2, down] = motion.handle[k];
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", motion.t_s[k], cells(X_VH.p), X_VH.q.w(),
                       X_VH.q.x(), X_VH.q.y(), X_VH.q.z(), cells(v_m_s), cells(omega_rad_s),
                       cells(a_m_s2), cells(alpha_rad_s2));
  }
  return out;
}

}  // namespace replay
}  // namespace tractus
