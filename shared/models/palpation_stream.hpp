/// A palpation that comes one moment at a time: how the handle moves between two moments, and how the
/// shank is taken along. Replay steps so, and so does an FMU.
#pragma once

#include <cstdint>

#include "models/palpation_runtime.hpp"

namespace tractus::models {

/// The published rate of the simulation, Hz: recorded motion is interpolated to it [Zoller2020,
/// "Parameter tuning"].
inline constexpr double kPalpationRate_Hz = 4000.0;
/// The longest time between two moments; the motion in a longer one is not known.
inline constexpr double kLongestGap_s = 1.0;

/// Steps from one moment to the next, each of at most 1 / kPalpationRate_Hz. The small allowance keeps
/// times printed with few digits from adding one.
std::uint64_t palpation_steps(double from_s, double to_s) noexcept;

/// How the handle moves at t, by the samples before and after it alone: on the cubic through both
/// positions with both accelerations, and on that of the quaternions, normalised, with
///
///     q̈ = ½ α q − ¼ |ω|² q
///
/// At a sample it is the sample; before the first and after the last, that one. With the derivatives
/// of PalpationMotion::through it is that spline: the position to rounding, the turn but for the
/// spline's own small error of length. With accelerations of zero it goes straight.
effects::HandleMotion between_samples(const PalpationMotion& motion, double t_s) noexcept;

/// The shank taken along a motion, from moment to moment in palpation_steps; each step starts from the
/// deflection of the last, the first from the unbent shank. A copy goes on from where the original
/// stands.
class PalpationWalk {
 public:
  /// @param runtime  must outlive this
  explicit PalpationWalk(const PalpationRuntime& runtime) : runtime_(&runtime) {}

  /// What a sensor would have said at a moment after the last, the delay included: the motion is asked
  /// for at that much earlier. No allocation.
  laws::PalpationStep to(double t_s, const PalpationMotion& motion) noexcept;

  std::uint64_t steps() const noexcept { return steps_; }
  std::uint64_t not_converged() const noexcept { return not_converged_; }  ///< of the steps

 private:
  laws::PalpationStep step(double t_s, const PalpationMotion& motion) noexcept;

  const PalpationRuntime* runtime_;
  laws::PalpationState state_;
  double t_s_ = 0.0;
  std::uint64_t steps_ = 0, not_converged_ = 0;
};

/// The same where the motion is known up to the moment alone. So the model's delay must not be below 0.
/// A copy goes on from where the original stands.
class PalpationStream {
 public:
  /// @param runtime  must outlive this
  explicit PalpationStream(const PalpationRuntime& runtime) : runtime_(&runtime), walk_(runtime) {}

  /// The answer at a moment after the last, at most kLongestGap_s after it; the motion has passed it.
  laws::PalpationStep keep(double t_s, const effects::HandleMotion& handle);

 private:
  void forget();

  const PalpationRuntime* runtime_;
  PalpationWalk walk_;
  PalpationMotion past_;  // as long ago as a delay reaches
};

}  // namespace tractus::models
