/// The linear actuator with its integrated stepper drive.
#pragma once

namespace tractus::rig {

/// Published: thrust and speed [Probing, section 3]. The rest is plausible, and ours.
struct LinearParameters {
  double rest_thrust_N = 667.0;    ///< at standstill
  double middle_thrust_N = 180.0;  ///< at `middle_speed_m_s`
  double middle_speed_m_s = 0.15;
  double top_speed_m_s = 0.23;  ///< no thrust is left there
  double mass_kg = 3.0;         ///< carriage, rotary stage and probe
  double lag_s = 0.002;         ///< of the speed behind its command
  double step_m = 5e-6;         ///< of the motor
  double travel_m = 0.1;
  double brake_m_s2 = 60.0;   ///< when the drive is off
  double overload_s = 0.005;  ///< for so long the load may be above the thrust
};

/// The carriage follows a speed command with a lag of first order, as far as the thrust allows:
///
///     v̇ = (v_cmd − v) / τ,   (F − T(|v|)) / m <= v̇ <= (F + T(|v|)) / m
///
/// F: load along x, positive into the bone; T: thrust, straight lines through the published points.
/// With the drive off a brake holds it. It stands at either end of the travel.
class LinearAxis {
 public:
  explicit LinearAxis(const LinearParameters& parameters) : p_(parameters) {}

  /// One step with the drive on. A command above the top speed is held to it.
  void drive(double speed_command_m_s, double load_N, double dt_s) noexcept;
  /// One step with the drive off.
  void brake(double dt_s) noexcept;

  double thrust_N(double speed_m_s) const noexcept;
  double x_m() const noexcept { return x_m_; }
  double v_m_s() const noexcept { return v_m_s_; }
  /// What the drive knows: whole steps.
  double counted_m() const noexcept;
  bool at_inner_stop() const noexcept { return x_m_ <= 0.0; }
  bool at_outer_stop() const noexcept { return x_m_ >= p_.travel_m; }
  /// The load has been above the thrust for longer than the drive bears.
  bool stalled() const noexcept { return overloaded_s_ > p_.overload_s; }
  const LinearParameters& parameters() const noexcept { return p_; }

 private:
  void move(double new_speed_m_s, double dt_s) noexcept;
  LinearParameters p_;
  double x_m_ = 0.0, v_m_s_ = 0.0, overloaded_s_ = 0.0;
  double last_dt_s_ = 0.0, caught_up_ = 0.0;  // 1 − exp(−dt/τ), kept while dt stays the same
};

}  // namespace tractus::rig
