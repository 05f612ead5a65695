#include "station/headset/touching_hand.hpp"

#include <cmath>
#include <numbers>

namespace tractus {
namespace headset {
namespace {
constexpr double kTravel_s = 1.0, kRest_s = 1.0, kPress_s = 0.3;  // of a rest, until it presses
constexpr double kTremor_m = 1e-4;
constexpr double kMiss_m = 3e-4;  // how far beside a point it comes to rest, along each axis

math::Vec3 miss_of(std::size_t point) {
  const double k = double(point) + 1.0;
  return kMiss_m * math::Vec3(std::sin(12.9 * k), std::sin(78.2 * k), std::sin(37.7 * k));
}
}  // namespace

math::Pose TouchingHand::stands_at() {
  math::Mat3 R;  // D: x to the person (+z of the room), y to the right (+x), z up (+y)
  R.col(0) = math::Vec3::UnitZ();
  R.col(1) = math::Vec3::UnitX();
  R.col(2) = math::Vec3::UnitY();
  const math::Quat turned(Eigen::AngleAxisd(0.2, math::Vec3::UnitY()));
  return {{0.05, 0.95, -0.6}, turned * math::Quat(R)};
}

TouchingHand::TouchingHand(std::span<const FixturePoint> points, const math::Vec3& tip_H_m)
    : tip_H_m_(tip_H_m) {
  const math::Pose X_DS = stands_at().inverse();
  for (const FixturePoint& point : points)
    tips_D_m_.push_back(X_DS * point.p_S_m + miss_of(tips_D_m_.size()));
}

core::Result<devices::Limits> TouchingHand::open() {
  start_ = -1;
  return devices::Limits{.max_force_N = 0.0,
                         .max_torque_Nm = 0.0,
                         .rate_Hz = 1000.0,
                         .name = "SIMULATED lambda.6 in a SIMULATED hand that touches points",
                         .simulated = true};
}

devices::Status TouchingHand::read(core::Instant_ns now, devices::Sample& out) noexcept {
  if (start_ < 0) start_ = now;
  const double t_s = 1e-9 * double(now - start_);
  const double cycle_s = kTravel_s + kRest_s;
  const auto leg = static_cast<std::size_t>(t_s / cycle_s);
  const double within_s = t_s - double(leg) * cycle_s;
  const std::size_t n = tips_D_m_.size();
  const math::Vec3 from = tips_D_m_[(leg + n - 1) % n], to = tips_D_m_[leg % n];
  const double tau = std::min(1.0, within_s / kTravel_s);
  const double share = tau * tau * tau * (10.0 + tau * (-15.0 + 6.0 * tau));
  math::Vec3 tip = from + share * (to - from);
  for (int a = 0; a < 3; ++a)
    tip[a] += kTremor_m * std::sin(2.0 * std::numbers::pi * (9.0 + a) * t_s + a);
  out = {};
  out.stamp = now;
  out.X_DH.p = tip - tip_H_m_;
  out.buttons = within_s > kTravel_s + kPress_s ? 1 : 0;
  return devices::Status::ok;
}

devices::Status TouchingHand::write(const math::Wrench& on_hand_D) noexcept {
  return on_hand_D.force_N.isZero() && on_hand_D.torque_Nm.isZero() ? devices::Status::ok
                                                                    : devices::Status::fault;
}

}  // namespace headset
}  // namespace tractus
