/// The rotary stage: probe, sensor and a servo motor that resists the turning hand.
#pragma once

namespace tractus::rig {

/// Plausible, and ours: the source gives no figure of the stage.
struct RotaryParameters {
  double inertia_kgm2 = 2e-4;
  double friction_Nms_per_rad = 1e-3;  ///< of bearings and motor; stays when the motor is off
  double peak_Nm = 1.0;
  double lag_s = 0.001;  ///< of the torque behind its command
};

/// J ω̇ = τ_hand + τ_motor − b ω;  τ̇_motor = (τ_cmd − τ_motor) / T.
class RotaryAxis {
 public:
  explicit RotaryAxis(const RotaryParameters& parameters) : p_(parameters) {}
  /// @param motor_Nm  the command, held to the motor's peak; 0 when it is off.
  void step(double motor_Nm, double hand_Nm, double dt_s) noexcept;
  double theta_rad() const noexcept { return theta_rad_; }
  double omega_rad_s() const noexcept { return omega_rad_s_; }

 private:
  RotaryParameters p_;
  double theta_rad_ = 0.0, omega_rad_s_ = 0.0, motor_Nm_ = 0.0;
  double last_dt_s_ = 0.0, caught_up_ = 0.0;  // 1 − exp(−dt/T), kept while dt stays the same
};

}  // namespace tractus::rig
