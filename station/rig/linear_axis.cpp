#include "station/rig/linear_axis.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::rig {

double LinearAxis::thrust_N(double speed_m_s) const noexcept {
  const double speed = std::abs(speed_m_s);
  if (speed <= p_.middle_speed_m_s)
    return std::lerp(p_.rest_thrust_N, p_.middle_thrust_N, speed / p_.middle_speed_m_s);
  const double share = (p_.top_speed_m_s - speed) / (p_.top_speed_m_s - p_.middle_speed_m_s);
  return std::max(0.0, p_.middle_thrust_N * share);
}

void LinearAxis::move(double new_speed_m_s, double dt_s) noexcept {
  x_m_ += 0.5 * (v_m_s_ + new_speed_m_s) * dt_s;
  v_m_s_ = new_speed_m_s;
  if (x_m_ <= 0.0) {
    x_m_ = 0.0;
    v_m_s_ = std::max(0.0, v_m_s_);
  } else if (x_m_ >= p_.travel_m) {
    x_m_ = p_.travel_m;
    v_m_s_ = std::min(0.0, v_m_s_);
  }
}

void LinearAxis::drive(double speed_command_m_s, double load_N, double dt_s) noexcept {
  const double wanted = std::clamp(speed_command_m_s, -p_.top_speed_m_s, p_.top_speed_m_s);
  const double thrust = thrust_N(v_m_s_);
  overloaded_s_ = std::abs(load_N) > thrust ? overloaded_s_ + dt_s : 0.0;
  if (dt_s != last_dt_s_) caught_up_ = -std::expm1(-(last_dt_s_ = dt_s) / p_.lag_s);
  const double lagged = (wanted - v_m_s_) * caught_up_;
  const double up = std::max(0.0, (load_N + thrust) / p_.mass_kg * dt_s);
  const double down = std::min(0.0, (load_N - thrust) / p_.mass_kg * dt_s);
  move(v_m_s_ + std::clamp(lagged, down, up), dt_s);
}

void LinearAxis::brake(double dt_s) noexcept {
  overloaded_s_ = 0.0;
  const double less = p_.brake_m_s2 * dt_s;
  move(v_m_s_ > 0.0 ? std::max(0.0, v_m_s_ - less) : std::min(0.0, v_m_s_ + less), dt_s);
}

double LinearAxis::counted_m() const noexcept { return p_.step_m * std::round(x_m_ / p_.step_m); }

}  // namespace tractus::rig
