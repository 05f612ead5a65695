/// The probing law and its effects made ready to run: replay, fit and the live loop step this one
/// object.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "effects/probing_effect.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_model.hpp"

namespace tractus::models {

using effects::ProbingMotion;

/// What a sensor would have said, one entry per sample.
struct ProbingForces {
  std::vector<double> fz_N;   ///< push of the hand along x
  std::vector<double> tz_Nm;  ///< empty when the motion has no angle
};

/// Which of them are asked for.
enum class ProbingOutput { force, torque, both };

inline constexpr std::size_t kMaxProbingEffects = 32;

/// The effects of a model by the stage at which they act, each in the model's order.
struct ProbingStages {
  std::vector<std::unique_ptr<effects::BoneDepth>> depths;
  std::vector<std::unique_ptr<effects::BoneScale>> scales;
  std::vector<std::unique_ptr<effects::ProbeForce>> forces;
  std::vector<std::unique_ptr<effects::ProbeTorque>> torques;
  std::vector<std::unique_ptr<effects::ForceDelay>> delays;
  std::vector<std::unique_ptr<effects::ForceSensor>> force_sensors;
  std::vector<std::unique_ptr<effects::TorqueSensor>> torque_sensors;

  void add(effects::ProbingEffect effect);
  /// Does one change the law's force, and so the live motion?
  bool act_along_probe() const noexcept {
    return !depths.empty() || !scales.empty() || !forces.empty();
  }
};

/// What changes from tick to tick of the live loop.
struct ProbingLive {
  laws::ProbingState at;   ///< depth of the tip and mode
  double v_m_s = 0.0;      ///< mean speed of the last tick
  double t_s = 0.0;        ///< since the start
  double theta_rad = 0.0;  ///< turned since the start
  bool started = false;    ///< set by the first tick, which starts the effects where `at` is
  std::array<effects::ProbingMemory, kMaxProbingEffects> effects{};  ///< depths, then forces
};

/// The law with effects at their stages. With x̃ the depth that the bone sees and s the factor of
/// the couplings:
///
///     fz = s · (D v + K (x̃ − x0)) + Σ f_e,   then late by the delay, plus bias, drift, crosstalk
///     tz = viscous and detent torque of the law + Σ τ_e, plus the sensor's bias
///
/// Runs both ways, as the law does. Immutable: safe to use from several threads at once, but for a
/// user's expression, whose runtime belongs to one thread at a time. Making one costs microseconds,
/// so a fit makes one for each set of numbers.
class ProbingRuntime {
 public:
  /// @param travel_m  the probe stop. Errors: out_of_range, bad_input or not_found naming the layer
  /// or the effect and its parameter.
  static core::Result<ProbingRuntime> make(const ProbingModel& model, double travel_m);
  /// The same for a law that has walls (a scenario's).
  static core::Result<ProbingRuntime> make(laws::ProbingParameters parameters,
                                           std::span<const effects::EffectInstance> uses);

  /// Force from motion, measurement effects included. The motion's arrays have one size; the last
  /// three may be empty. A sample's dt is that since the sample before. What is not asked for is left empty.
  void predict(const ProbingMotion& motion, ProbingForces& out,
               ProbingOutput wanted = ProbingOutput::both) const;

  /// Motion from force, the live rig: one tick of length `dt_s` under the push `force_N` while the
  /// probe turns at `turning_rad_s`. Sought is the speed v at which the resistance at the tick's
  /// end equals the push (implicit Euler: stiff branches, mass and dry friction need no smaller
  /// step),
  ///
  ///     force_N = s (D v + K (x̃(x + v dt) − x0)) + Σ f_e(x + v dt, v, (v − v_before)/dt),
  ///
  /// so that `predict` over the recorded ticks gives the push back. Where dry friction can hold the
  /// probe it rests; of several speeds (friction that falls with speed) it takes the one nearest to
  /// the present motion. Measurement effects are left out. Without effects it is the law's own
  /// `advance`. Returns the mean speed, m/s. Never fails, allocates or locks; at most some hundred
  /// evaluations of the law.
  double advance(double force_N, double turning_rad_s, double dt_s,
                 ProbingLive& live) const noexcept;

  /// Torque of the hand on the probe, the live rotary stage: the law's with the effects', which its
  /// motor renders; nothing behind a wall, where the motor is off. Dry friction begins softly over
  /// kSoft_rad_s, or the stage would chatter about rest.
  double torque_Nm(double x_m, double theta_rad, double turning_rad_s) const noexcept;
  static constexpr double kSoft_rad_s = 0.05;

  const laws::ProbingLaw& law() const noexcept { return law_; }
  /// How much later than the motion a force is recorded, s.
  double delay_s() const noexcept { return delay_s_; }

 private:
  friend class ProbingStream;
  ProbingRuntime(laws::ProbingLaw law, ProbingStages stages);
  void predict_force(const ProbingMotion& motion, std::span<double> fz_N) const;
  void predict_torque(const ProbingMotion& motion, std::span<double> tz_Nm) const;
  double added_torque_Nm(const effects::ProbingTick& tick, double torque_Nm) const noexcept;

  laws::ProbingLaw law_;
  ProbingStages stages_;
  double delay_s_ = 0.0;
};

}  // namespace tractus::models
