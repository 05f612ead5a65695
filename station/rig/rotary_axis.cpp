#include "station/rig/rotary_axis.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::rig {

void RotaryAxis::step(double motor_Nm, double hand_Nm, double dt_s) noexcept {
  const double wanted = std::clamp(motor_Nm, -p_.peak_Nm, p_.peak_Nm);
  if (dt_s != last_dt_s_) caught_up_ = -std::expm1(-(last_dt_s_ = dt_s) / p_.lag_s);
  motor_Nm_ += (wanted - motor_Nm_) * caught_up_;
  // Semi-implicit in the friction, so that any inertia is stable.
  omega_rad_s_ = (omega_rad_s_ + dt_s * (hand_Nm + motor_Nm_) / p_.inertia_kgm2) /
                 (1.0 + dt_s * p_.friction_Nms_per_rad / p_.inertia_kgm2);
  theta_rad_ += omega_rad_s_ * dt_s;
}

}  // namespace tractus::rig
