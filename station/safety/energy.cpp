#include "station/safety/energy.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace safety {
namespace {
using math::Vec3;

/// Axis times angle of the turn from `a` to `b`, in D.
Vec3 turn_between(const math::Quat& a, const math::Quat& b) {
  math::Quat q = b * a.conjugate();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double s = q.vec().norm();
  return s > 1e-12 ? Vec3(q.vec() * (2.0 * std::atan2(s, q.w()) / s)) : Vec3(2.0 * q.vec());
}

/// Strength of the damper that takes `power_W` at this speed; lowers `power_W` by what it takes.
double damper(double& power_W, double square, double most) {
  if (square < 1e-12 || power_W <= 0.0) return 0.0;
  const double b = std::min(most, power_W / square);
  power_W -= b * square;
  return b;
}
}  // namespace

void EnergyObserver::moved_to(const math::Pose& X_DH) noexcept {
  last_J_ = 0.0;
  if (seen_)
    last_J_ =
        held_.force_N.dot(X_DH.p - last_.p) + held_.torque_Nm.dot(turn_between(last_.q, X_DH.q));
  last_ = X_DH;
  seen_ = true;
  given_J_ += last_J_;
  injected_J_ = std::max(injected_J_, given_J_);
}

math::Wrench PassivityController::damped(const math::Wrench& wanted, double given_J,
                                         const Vec3& velocity_m_s, const Vec3& turn_rad_s,
                                         double period_s) noexcept {
  if (given_J <= kAllowance_J) return wanted;
  double power_W = (given_J - kAllowance_J) / period_s;
  const double b = damper(power_W, velocity_m_s.squaredNorm(), kMost_Ns_per_m);
  const double c = damper(power_W, turn_rad_s.squaredNorm(), kMost_Nms_per_rad);
  return {wanted.force_N - b * velocity_m_s, wanted.torque_Nm - c * turn_rad_s};
}

}  // namespace safety
}  // namespace tractus
