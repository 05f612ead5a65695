#include "replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "math/spline.hpp"

namespace tractus {
namespace replay {
namespace {

using core::Errc;
using core::Error;

constexpr double kLongestGap_s = 1.0;
constexpr double kMostSteps = 1e9;
constexpr std::size_t kSamplesPerWord = 256;  // between two words to the progress

/// Steps from one recorded time to the next. The small allowance keeps times printed with few
/// digits from adding one.
std::uint64_t steps_between(double from_s, double to_s) {
  return std::uint64_t(std::max(1.0, std::ceil((to_s - from_s) * kRate_Hz - 1e-3)));
}

core::Result<double> steps_of(const trial::PalpationMeasurement& recording) {
  double steps = 1.0;
  for (std::size_t k = 1; k < recording.t_s.size(); ++k) {
    const double from = recording.t_s[k - 1], to = recording.t_s[k];
    if (to - from > kLongestGap_s)
      return Error{
          Errc::bad_input,
          fmt::format("{}: no sample between {} s and {} s; gaps of at most {} s are replayed",
                      recording.file, from, to, kLongestGap_s)};
    steps += double(steps_between(from, to));
  }
  if (steps > kMostSteps)
    return Error{Errc::bad_input,
                 fmt::format("{}: {:.3g} steps of {} Hz, at most {:.0g} are replayed",
                             recording.file, steps, kRate_Hz, kMostSteps)};
  return steps;
}

/// Holds what runs through a replay from step to step.
class Run {
 public:
  explicit Run(const models::PalpationRuntime& runtime) : runtime_(runtime) {}

  laws::PalpationStep step(const effects::HandleMotion& handle) {
    const auto answer = runtime_.recorded(handle, state_);
    ++out_.steps;
    out_.not_converged += !answer.converged;
    return answer;
  }

  void keep(const effects::HandleMotion& handle) {
    const auto answer = step(handle);
    out_.wrench_H.push_back(answer.wrench_H);
    out_.deflection_m.push_back(answer.deflection_m);
    out_.converged.push_back(answer.converged);
    out_.samples_in_volume +=
        runtime_.field().geometry().contains(runtime_.tip_m(handle.X_VH, answer.deflection_m));
  }

  Replayed result() && { return std::move(out_); }

 private:
  const models::PalpationRuntime& runtime_;
  laws::PalpationState state_;
  Replayed out_;
};

/// The recorded motion: poses through a spline, the recorded ones exactly, derivatives from it.
class Motion {
 public:
  Motion(const trial::PalpationMeasurement& recording, const math::PoseSpline& spline,
         const math::Vec3& down, double delay_s)
      : recording_(recording), spline_(spline), down_(down), delay_s_(delay_s) {}

  effects::HandleMotion at(double t_s) const {
    const double t = std::clamp(t_s - delay_s_, recording_.t_s.front(), recording_.t_s.back());
    return {spline_.pose(t),
            spline_.velocity_m_s(t),
            spline_.angular_velocity_rad_s(t),
            spline_.acceleration_m_s2(t),
            spline_.angular_acceleration_rad_s2(t),
            down_};
  }
  effects::HandleMotion at_sample(std::size_t k) const {
    effects::HandleMotion out = at(recording_.t_s[k]);
    if (delay_s_ == 0.0) out.X_VH = recording_.X_VH[k];
    return out;
  }

 private:
  const trial::PalpationMeasurement& recording_;
  const math::PoseSpline& spline_;
  math::Vec3 down_;
  double delay_s_;
};

}  // namespace

core::Result<Replayed> replay(const models::PalpationRuntime& runtime,
                              const trial::PalpationMeasurement& recording, const math::Vec3& down,
                              const core::Progress& progress) {
  TRY(steps_of(recording));
  const auto spline = math::PoseSpline::make(recording.t_s, recording.X_VH);
  if (!spline) return Error{spline.error().code, recording.file + ": " + spline.error().what};
  const Motion motion(recording, *spline, down, runtime.delay_s());
  Run run(runtime);
  run.keep(motion.at_sample(0));
  for (std::size_t k = 1; k < recording.t_s.size(); ++k) {
    const double from = recording.t_s[k - 1], width = recording.t_s[k] - from;
    const std::uint64_t steps = steps_between(from, recording.t_s[k]);
    for (std::uint64_t s = 1; s < steps; ++s)
      run.step(motion.at(from + width * double(s) / double(steps)));
    run.keep(motion.at_sample(k));
    if (progress && k % kSamplesPerWord == 0 && !progress(double(k) / double(recording.t_s.size())))
      return Error{Errc::cancelled, "the replay was stopped"};
  }
  return std::move(run).result();
}

}  // namespace replay
}  // namespace tractus
