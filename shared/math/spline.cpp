#include "math/spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/try.hpp"

namespace tractus::math {

core::Result<CubicSpline> CubicSpline::make(std::span<const double> t, std::span<const double> y) {
  if (t.size() < 2 || t.size() != y.size())
    return core::Error{core::Errc::bad_input, "a spline needs at least two points"};
  for (std::size_t k = 1; k < t.size(); ++k)
    if (!(t[k] > t[k - 1]))
      return core::Error{
          core::Errc::bad_input,
          fmt::format("time {} s does not come after {} s (point {})", t[k], t[k - 1], k)};
  CubicSpline out;
  out.t_.assign(t.begin(), t.end());
  out.y_.assign(y.begin(), y.end());
  const std::size_t n = t.size();
  out.m_.assign(n, 0.0);
  // The tridiagonal system of the second derivatives, by elimination (Thomas).
  std::vector<double> upper(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double left = t[k] - t[k - 1], right = t[k + 1] - t[k];
    const double diagonal = 2.0 * (left + right) - left * upper[k - 1];
    const double jump = 6.0 * ((y[k + 1] - y[k]) / right - (y[k] - y[k - 1]) / left);
    upper[k] = right / diagonal;
    out.m_[k] = (jump - left * out.m_[k - 1]) / diagonal;
  }
  for (std::size_t k = n - 1; k-- > 1;) out.m_[k] -= upper[k] * out.m_[k + 1];
  return out;
}

CubicSpline::At CubicSpline::at(double t) const noexcept {
  const auto after = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  const auto k = static_cast<std::size_t>(after - t_.begin()) - 1;
  const double h = t_[k + 1] - t_[k];
  return {k, h, (t_[k + 1] - t) / h, (t - t_[k]) / h};
}

double CubicSpline::value(double t) const noexcept {
  const auto [k, h, a, b] = at(t);
  return a * y_[k] + b * y_[k + 1] +
         ((a * a * a - a) * m_[k] + (b * b * b - b) * m_[k + 1]) * h * h / 6.0;
}

double CubicSpline::derivative(double t) const noexcept {
  const auto [k, h, a, b] = at(t);
  return (y_[k + 1] - y_[k]) / h +
         ((3.0 * b * b - 1.0) * m_[k + 1] - (3.0 * a * a - 1.0) * m_[k]) * h / 6.0;
}

double CubicSpline::second_derivative(double t) const noexcept {
  const auto [k, h, a, b] = at(t);
  return a * m_[k] + b * m_[k + 1];
}

core::Result<PoseSpline> PoseSpline::make(std::span<const double> t, std::span<const Pose> X) {
  std::array<std::vector<double>, 7> columns;
  Quat last = Quat::Identity();
  for (const Pose& pose : X) {
    Quat q = pose.q.normalized();
    if (q.dot(last) < 0.0) q.coeffs() = -q.coeffs();
    last = q;
    const std::array values{pose.p.x(), pose.p.y(), pose.p.z(), q.w(), q.x(), q.y(), q.z()};
    for (std::size_t c = 0; c < 7; ++c) columns[c].push_back(values[c]);
  }
  PoseSpline out;
  for (std::size_t c = 0; c < 7; ++c) {
    auto spline = TRY(CubicSpline::make(t, columns[c]));
    (c < 3 ? out.p_ : out.q_).push_back(std::move(spline));
  }
  return out;
}

Pose PoseSpline::pose(double t) const noexcept {
  const Quat q(q_[0].value(t), q_[1].value(t), q_[2].value(t), q_[3].value(t));
  return {{p_[0].value(t), p_[1].value(t), p_[2].value(t)}, q.normalized()};
}

Vec3 PoseSpline::velocity_m_s(double t) const noexcept {
  return {p_[0].derivative(t), p_[1].derivative(t), p_[2].derivative(t)};
}

Vec3 PoseSpline::acceleration_m_s2(double t) const noexcept {
  return {p_[0].second_derivative(t), p_[1].second_derivative(t), p_[2].second_derivative(t)};
}

Vec3 PoseSpline::angular_velocity_rad_s(double t) const noexcept {
  // ω = 2 q̇ q*, with the unnormalised spline's norm n divided out (the part of q̇ along q drops from
  // the vector part).
  const Quat q(q_[0].value(t), q_[1].value(t), q_[2].value(t), q_[3].value(t));
  const Quat dq(q_[0].derivative(t), q_[1].derivative(t), q_[2].derivative(t), q_[3].derivative(t));
  return 2.0 * (dq * q.conjugate()).vec() / q.squaredNorm();
}

Vec3 PoseSpline::angular_acceleration_rad_s2(double t) const noexcept {
  // d/dt of 2 vec(q̇ q*)/n²:  2 vec(q̈ q*)/n² (q̇ q̇* has no vector part) less ω d(n²)/dt / n².
  const Quat q(q_[0].value(t), q_[1].value(t), q_[2].value(t), q_[3].value(t));
  const Quat dq(q_[0].derivative(t), q_[1].derivative(t), q_[2].derivative(t), q_[3].derivative(t));
  const Quat ddq(q_[0].second_derivative(t), q_[1].second_derivative(t), q_[2].second_derivative(t),
                 q_[3].second_derivative(t));
  const double n2 = q.squaredNorm();
  const Vec3 omega = 2.0 * (dq * q.conjugate()).vec() / n2;
  return 2.0 * (ddq * q.conjugate()).vec() / n2 - omega * (2.0 * q.dot(dq) / n2);
}

}  // namespace tractus::math
