/// Effects of the probing law: the stages at which one may act, and the catalogue of them.
///
/// A stage is a class with one function; an effect is one stage's object, made once from its
/// numbers. In the order in which force and torque come about:
///
///     depth      BoneDepth      the depth and speed that the bone sees
///     scale      BoneScale      a factor on the bone's resistance K(x − x0) + D v
///     force      ProbeForce     what adds to the resistance
///     torque     ProbeTorque    what adds to the turning stage's torque
///     delay      ForceDelay     when the force is recorded (measurement)
///     recording  ForceSensor    what the force sensor says on top (measurement)
///                TorqueSensor   what the torque sensor says on top (measurement)
///
/// Several of one stage add; the factors of `scale` multiply; the depths of `depth` follow one
/// another as in the model.
///
/// All are const: what changes from tick to tick is in the caller's ProbingMemory, so that one object
/// serves many recordings and the live loop at once. A tick may be only a candidate (the live loop
/// seeks the speed at which resistance equals push); its caller then passes a copy of the memory.
/// The first four never allocate, lock or fail; the last three may allocate and never run live.
///
/// Signs: x into the bone; forces are the push of the hand along x that the effect asks for.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "effects/effect.hpp"
#include "effects/memory_operator.hpp"

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

/// What an effect keeps from one moment to the next.
struct ProbingMemory {
  /// Before the first moment: the depth there.
  double depth_m = 0.0;
  std::array<double, 3> own{};  ///< before the first moment: 0
  FormulaMemory formula = {};   ///< of a user's own effect
};

class BoneDepth {
 public:
  virtual ~BoneDepth() = default;
  /// Turns depth and speed of a tick into those that the bone sees, and moves the memory on to it.
  virtual void see(ProbingTick& tick, ProbingMemory& memory) const noexcept = 0;
};

class BoneScale {
 public:
  virtual ~BoneScale() = default;
  /// A factor on the bone's resistance.
  virtual double scale(const ProbingTick& tick) const noexcept = 0;
};

class ProbeForce {
 public:
  virtual ~ProbeForce() = default;
  /// What adds to the resistance, N; moves the memory on to the tick. @param base_N  the bone's
  /// resistance after depth and scale.
  virtual double force_N(const ProbingTick& tick, double base_N,
                         ProbingMemory& memory) const noexcept = 0;
};

class ProbeTorque {
 public:
  virtual ~ProbeTorque() = default;
  /// What adds to the turning stage's torque, N·m about x.
  virtual double torque_Nm(const ProbingTick& tick) const noexcept = 0;
};

class ForceDelay {
 public:
  virtual ~ForceDelay() = default;
  /// Moves the force over a whole trial, N, in time.
  virtual void delay(const ProbingMotion& motion, std::span<double> fz_N) const = 0;
};

class ForceSensor {
 public:
  virtual ~ForceSensor() = default;
  /// Adds to the force over a whole trial, N, what the sensor says on top.
  virtual void record(const ProbingMotion& motion, std::span<double> fz_N) const = 0;
};

class TorqueSensor {
 public:
  virtual ~TorqueSensor() = default;
  /// Adds to the torque over a whole trial, N·m, what the sensor says on top.
  virtual void record(const ProbingMotion& motion, std::span<double> tz_Nm) const = 0;
};

/// An effect: the object of the stage that it acts at.
using ProbingEffect = std::variant<std::unique_ptr<BoneDepth>, std::unique_ptr<BoneScale>,
                                   std::unique_ptr<ProbeForce>, std::unique_ptr<ProbeTorque>,
                                   std::unique_ptr<ForceDelay>, std::unique_ptr<ForceSensor>,
                                   std::unique_ptr<TorqueSensor>>;

/// What recordings show before an effect is added, for the numbers that its search begins with.
struct ProbingStatistics {
  double slow_m_s = 0.0;       ///< 2 % of the moving samples are slower
  double fast_m_s = 0.0;       ///< 90 % of the moving samples are slower
  double depth_range_m = 0.0;  ///< from the least depth to the greatest
  double longest_s = 0.0;      ///< duration of the longest trial
  /// The residual (measured − predicted) at moments of all trials: the depth, the residual in units
  /// of its expected standard deviation, and that, N.
  std::vector<double> depth_m = {}, residual = {}, residual_sd_N = {};
};

/// An entry of the catalogue.
struct ProbingEffectInfo {
  EffectFacts facts;
  /// @param values  in the order of the params, components flattened; already within their ranges.
  ProbingEffect (*make)(std::span<const double> values);
  /// Starts that depend on the recordings; may find none. Null: facts.starts.
  Starts (*starts)(const ProbingStatistics& recordings) = nullptr;
};

/// For ProbingEffectInfo::make: an effect at one stage.
template <class Stage, class Effect>
ProbingEffect made(std::span<const double> values) {
  return std::unique_ptr<Stage>(std::make_unique<Effect>(values));
}

/// Values spread evenly in their logarithm between two limits, which are left out.
std::vector<double> spread(double low, double high, int count);

/// The catalogue, in the order of the ids; made from the files of probing/.
const std::vector<ProbingEffectInfo>& probing_effects();
/// The entry of an id; null where the catalogue has none.
const ProbingEffectInfo* find_probing_effect(std::string_view id);

/// What is known of an effect in a model, of the catalogue or a user's own; its numbers do not
/// matter. Errors: not_found naming the id; bad_input naming what is wrong in a definition.
core::Result<EffectFacts> probing_facts(const EffectInstance& use);

/// The effect of an id with its numbers. Errors: not_found naming the id; bad_input or out_of_range
/// naming the parameter, its value and its range.
core::Result<ProbingEffect> make_probing_effect(const EffectInstance& use);

}  // namespace tractus::effects
