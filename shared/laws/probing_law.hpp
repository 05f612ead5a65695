/// The channelling of a pedicle with a probe on the rotary and linear rig: layered bone, walls,
/// breaches.
#pragma once

#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/probing_mode.hpp"
#include "core/result.hpp"

namespace tractus::laws {

/// One layer of bone [Probing, Fig. 4]: spring and damper of its own between two depths.
struct Layer {
  double start_m = 0.0;            ///< depth at which it begins, >= 0
  double thickness_m = 0.0;        ///< > 0
  double stiffness_N_per_m = 0.0;  ///< K, >= 0
  double damping_Ns_per_m = 0.0;   ///< D, > 0
  double equilibrium_m = 0.0;      ///< x0, depth at which its spring is at rest
};

/// A cortical wall and what lies behind it [Probing, section 4].
struct CorticalWall {
  double position_m = 0.0;               ///< breach threshold: depth at which the bone gives way
  double resistance_interval_m = 0.0;    ///< R_i: K and D grow over this length before the wall
  double resistance_factor_per_m = 0.0;  ///< R_f: share by which they grow per metre
  double breach_interval_m = 0.0;        ///< L_b: length of soft tissue behind
  double breach_damping_Ns_per_m = 0.0;  ///< D_b, > 0
};

/// The rotary stage: viscous friction and detents, rendered by a gain-scheduled PD controller
/// [Probing, section 4].
struct RotaryStage {
  double viscous_Nms_per_rad = 0.02;  ///< V, the D gain
  double detent_Nm = 0.01;            ///< T, the most that a detent holds
  double detent_pitch_rad = 0.35;     ///< p

  bool operator==(const RotaryStage&) const = default;
};

/// The rotary controller's gains in force at a place.
struct RotaryGains {
  double proportional_Nm_per_rad = 0.0;  ///< P, on the angle from the nearest detent
  double derivative_Nms_per_rad = 0.0;   ///< V, on the speed
  double from_detent_rad = 0.0;          ///< e, of the angle, within half a pitch
};

struct ProbingParameters {
  std::vector<Layer> layers;        ///< by depth, without overlap; may be empty
  std::vector<CorticalWall> walls;  ///< by depth; breach stretches without overlap
  RotaryStage rotary;
  double travel_m = 0.1;  ///< the probe stop
  double min_turning_rad_s =
      10.0 * std::numbers::pi / 180.0;  ///< the stage holds below this [Probing: 10 °/s]
  double max_speed_m_s = 0.23;          ///< of the actuator
};

using core::ProbingMode;

/// What changes from tick to tick.
struct ProbingState {
  double x_m = 0.0;  ///< depth of the tip, positive into the bone
  ProbingMode mode = ProbingMode::holding;
};

/// The admittance law of the linear stage and the rendered torque of the rotary stage [Probing, eqs
/// (1)–(3)]:
///
///     M(ẍ − ẍ0) + D(ẋ − ẋ0) + K(x − x0) = F,  M = 0, ẋ0 = 0                 (1)
///     ẋ = (F − K(x − x0)) / D                        in a layer               (2)
///     ẋ = F / D_b                                    behind a wall, over L_b  (3)
///     K, D → K, D · (1 + R_f (x − x_w + R_i))        for x_w − R_i <= x < x_w
///
/// The stage moves only while the probe turns faster than 10 °/s. Between layers, and past the
/// last, the resistance is 0 and the stage moves at the actuator's speed. Runs both ways: motion
/// from force (`advance`, the live rig) and force from motion (`force_N`, the lab). Departs from
/// the source: R_f is per metre, so that a slope over R_i is unambiguous; speed is held within the
/// actuator's.
class ProbingLaw {
 public:
  /// Errors: out_of_range or bad_input naming the layer or wall and the number outside its range.
  static core::Result<ProbingLaw> make(ProbingParameters parameters);

  /// One tick of length `dt_s` under the push `force_N` while the probe turns at `turning_rad_s`:
  /// midpoint rule, cut at the borders of layers, walls and travel. Returns the mean speed, m/s.
  /// Never fails, never allocates.
  double advance(double force_N, double turning_rad_s, double dt_s,
                 ProbingState& state) const noexcept;

  /// Push needed at depth `x_m` to move at `speed_m_s`, eqs (2), (3) solved for F.
  double force_N(double x_m, double speed_m_s) const noexcept;
  /// The same along a path. @param stretch  where the depth before lay, 0 at first: any value is
  /// right, a near one is fast.
  double force_N(double x_m, double speed_m_s, std::size_t& stretch) const noexcept;
  /// The rotary PD's gains at a depth and an angle θ, e = θ − p · round(θ / p):
  ///
  ///     τ = P(e) e + V ω,   P(e) = T sin(2π e / p) / e
  ///
  /// P is scheduled on the distance from the detent: 2πT/p at its bottom, 0 midway, so that the way
  /// to the next one is smooth. Behind a wall both are 0: the motor is off. The source names the
  /// controller and prints no gains; the schedule is our own.
  RotaryGains rotary_gains(double x_m, double theta_rad) const noexcept;
  /// Torque of the hand on the probe needed at angle θ and speed ω.
  double torque_Nm(double x_m, double theta_rad, double turning_rad_s) const noexcept;
  /// The other way: the speed at which the stage's resistance balances the hand's torque, within
  /// ±kFreeTurning_rad_s, which a hand reaches where nothing resists; 0 for no torque at rest.
  double turning_rad_s(double x_m, double theta_rad, double torque_Nm) const noexcept;
  static constexpr double kFreeTurning_rad_s = 40.0;

  /// The next depth at which the law changes, in the direction of motion; the travel's ends are
  /// such.
  double next_border_m(double x_m, bool inward) const noexcept;
  /// The mode at a depth for a probe that turns.
  ProbingMode mode_at(double x_m) const noexcept;
  const ProbingParameters& parameters() const noexcept { return parameters_; }

 private:
  /// K, D and x0 in force at a depth.
  struct Local {
    double stiffness_N_per_m, damping_Ns_per_m, equilibrium_m;
  };
  /// Between two borders: K, D and x0 at its start, and the share by which they grow per metre.
  struct Stretch {
    double start_m = 0.0;
    Local at_start{};
    ProbingMode mode = ProbingMode::bone;
    double grows_from_m = 0.0, growth_per_m = 0.0;
  };
  explicit ProbingLaw(ProbingParameters parameters) : parameters_(std::move(parameters)) {}
  void lay_out();
  Stretch stretch_from(double start_m) const;
  const Stretch& stretch_at(double x_m) const noexcept;
  Local local(double x_m) const noexcept;
  double speed_m_s(double force_N, double x_m) const noexcept;
  ProbingParameters parameters_;
  std::vector<double> borders_m_;   // all depths at which the law changes, sorted
  std::vector<Stretch> stretches_;  // the first from −∞ on, then one from each border on
};

}  // namespace tractus::laws
