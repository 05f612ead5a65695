/// One physical effect on the probing rig, as replay, fit and the live loop run it. One file each
/// in probing/.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "effects/effect.hpp"

namespace tractus::effects {

/// A recorded motion, one entry per sample; the last three may be empty: not recorded.
struct ProbingMotion {
  std::vector<double> t_s = {}, x_m = {}, v_m_s = {}, a_m_s2 = {};
  std::vector<double> theta_rad = {}, omega_rad_s = {}, tz_Nm = {};
  /// Speed below which the motion counts as rest, about three times the error of v_m_s: where
  /// sgn v is asked for, see direction().
  double rest_m_s = 1e-5;
  double rest_rad_s = 1e-4;  ///< the same of omega_rad_s

  std::size_t size() const noexcept { return x_m.size(); }
};

/// One moment of a motion, measured or sought by the live loop.
struct ProbingTick {
  double t_s = 0.0;
  double dt_s = 0.0;  ///< since the moment before; 0 at the first
  double x_m = 0.0, v_m_s = 0.0, a_m_s2 = 0.0;
  double theta_rad = 0.0, omega_rad_s = 0.0, tz_Nm = 0.0;
  double rest_m_s = 0.0;    ///< as in ProbingMotion; 0 in the live loop, whose speed is exact
  double rest_rad_s = 0.0;  ///< as in ProbingMotion
};

/// sgn v of a motion known to within `rest_m_s`: 0 below it, ±1 from twice it on, straight between.
/// With rest 0 the plain sign. A pause whose speed is only noise so has no direction, as sgn 0 = 0
/// has none, and does not chatter.
inline double direction(double v_m_s, double rest_m_s) noexcept {
  const double speed = v_m_s < 0.0 ? -v_m_s : v_m_s;
  if (speed <= rest_m_s) return 0.0;
  const double share = speed >= 2.0 * rest_m_s ? 1.0 : (speed - rest_m_s) / rest_m_s;
  return v_m_s < 0.0 ? -share : share;
}

/// Where in the law an effect acts, in the order in which they act. Several of one stage add (the
/// factors of `scale` multiply, the depths of `depth` follow one another as in the model).
enum class ProbingStage {
  depth,      ///< the depth and speed that the bone sees
  scale,      ///< a factor on the bone's resistance K(x − x0) + D v
  force,      ///< added to the resistance
  torque,     ///< added to the turning stage's torque
  delay,      ///< moves the recorded force in time (measurement)
  recording,  ///< added to the recorded force (measurement)
};

/// Most numbers of state that one effect keeps.
inline constexpr std::size_t kMaxProbingStates = 4;

/// One effect with its numbers. Immutable: what changes from tick to tick is in the caller's
/// `state`, so that one object serves many recordings and the live loop at once. A stage's function
/// is called for a moment that may only be a candidate (the live loop seeks the speed at which
/// resistance equals push); `commit` then says that the moment has been. Nothing here allocates,
/// locks or fails, `record` excepted, which may allocate and never runs live.
///
/// Signs: x into the bone; forces are the push of the hand along x that the effect asks for.
class ProbingEffect {
 public:
  virtual ~ProbingEffect() = default;
  virtual ProbingStage stage() const noexcept = 0;

  /// Numbers of state, at most kMaxProbingStates.
  virtual std::size_t states() const noexcept { return 0; }
  /// The state before the first moment.
  virtual void start(const ProbingTick& /*first*/, double* /*state*/) const noexcept {}
  /// Moves the state over the moment that has been. At `depth`, depth and speed are those that came
  /// into it.
  virtual void commit(const ProbingTick& /*tick*/, double* /*state*/) const noexcept {}

  /// Stage depth: turns depth and speed of the tick into those that the bone sees.
  virtual void see(ProbingTick& /*tick*/, const double* /*state*/) const noexcept {}
  /// Stage scale: a factor.
  virtual double scale(const ProbingTick& /*tick*/) const noexcept { return 1.0; }
  /// Stage force: N. @param base_N  the bone's resistance after depth and scale.
  virtual double force_N(const ProbingTick& /*tick*/, double /*base_N*/,
                         const double* /*state*/) const noexcept {
    return 0.0;
  }
  /// Stage torque: N·m about x that the hand must add at that moment, from depth, angle and turning
  /// alone; without state.
  virtual double torque_Nm(const ProbingTick& /*tick*/) const noexcept { return 0.0; }
  /// force_N and commit in one: what a replay calls, sample after sample.
  virtual double replay_N(const ProbingTick& tick, double base_N, double* state) const noexcept {
    const double out_N = force_N(tick, base_N, state);
    commit(tick, state);
    return out_N;
  }
  /// Stages delay and recording: turns the law's force over a whole trial, N, into what the sensor
  /// says.
  virtual void record(const ProbingMotion& /*motion*/, std::span<double> /*fz_N*/) const {}
  /// Stage recording: the same of the torque, N·m.
  virtual void record_torque(const ProbingMotion& /*motion*/, std::span<double> /*tz_Nm*/) const {}
};

/// An entry of the catalogue.
struct ProbingEffectInfo {
  EffectFacts facts;
  /// @param values  in the order of the params, components flattened; already within their ranges.
  std::unique_ptr<ProbingEffect> (*make)(std::span<const double> values);
};

/// For ProbingEffectInfo::make.
template <class Effect>
std::unique_ptr<ProbingEffect> made(std::span<const double> values) {
  return std::make_unique<Effect>(values);
}

/// The catalogue, in the order of the ids; made from the files of probing/.
const std::vector<ProbingEffectInfo>& probing_effects();

/// What is known of an effect in a model, of the catalogue or a user's own; its numbers do not
/// matter. Errors: not_found naming the id; bad_input naming what is wrong in a definition.
core::Result<EffectFacts> probing_facts(const EffectInstance& use);

/// The effect of an id with its numbers. Errors: not_found naming the id; bad_input or out_of_range
/// naming the parameter, its value and its range.
core::Result<std::unique_ptr<ProbingEffect>> make_probing_effect(const EffectInstance& use);

}  // namespace tractus::effects
