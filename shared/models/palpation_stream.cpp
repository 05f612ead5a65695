#include "models/palpation_stream.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace models {
namespace {

using effects::HandleMotion;
using math::Vec3;
using Vec4 = Eigen::Vector4d;

constexpr std::ptrdiff_t kForgottenMoments = 32;  // at once, so that each moment costs little

/// A cubic over an interval of width h by values and second derivatives at its ends, as
/// math::CubicSpline has them.
template <class V>
struct Cubic {
  V y0, y1, m0, m1;
  double h, a, b;  // a, b: weights of the left and the right end

  V value() const {
    return a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0;
  }
  V derivative() const {
    return (y1 - y0) / h + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0;
  }
  V second_derivative() const { return a * m0 + b * m1; }
};

/// q̈ of a unit quaternion that turns with ω and α: q̇ = ½ ω q, so q̈ = ½ α q + ¼ ω ω q.
Vec4 second_derivative(const HandleMotion& handle, const math::Quat& q) {
  const Vec3 half = 0.5 * handle.alpha_rad_s2;
  const math::Quat turned = math::Quat(0.0, half.x(), half.y(), half.z()) * q;
  return turned.coeffs() - 0.25 * handle.omega_rad_s.squaredNorm() * q.coeffs();
}

HandleMotion on_cubics(const HandleMotion& from, const HandleMotion& to, double h, double a,
                       double b) {
  const Cubic<Vec3> place{from.X_VH.p, to.X_VH.p, from.a_m_s2, to.a_m_s2, h, a, b};
  const math::Quat& q0 = from.X_VH.q;
  math::Quat q1 = to.X_VH.q;
  if (q1.dot(q0) < 0.0) q1.coeffs() = -q1.coeffs();
  const Cubic<Vec4> turn{
      q0.coeffs(), q1.coeffs(), second_derivative(from, q0), second_derivative(to, q1), h, a, b};
  const math::Quat q(turn.value()), dq(turn.derivative()), ddq(turn.second_derivative());
  const double n2 = q.squaredNorm();  // as math::PoseSpline divides it out
  HandleMotion out;
  out.X_VH = {place.value(), q.normalized()};
  out.v_m_s = place.derivative();
  out.a_m_s2 = place.second_derivative();
  out.omega_rad_s = 2.0 * (dq * q.conjugate()).vec() / n2;
  out.alpha_rad_s2 =
      2.0 * (ddq * q.conjugate()).vec() / n2 - out.omega_rad_s * (2.0 * q.dot(dq) / n2);
  out.down = to.down;
  return out;
}

}  // namespace

std::uint64_t palpation_steps(double from_s, double to_s) noexcept {
  return std::uint64_t(std::max(1.0, std::ceil((to_s - from_s) * kPalpationRate_Hz - 1e-3)));
}

HandleMotion between_samples(const PalpationMotion& motion, double t_s) noexcept {
  const auto& times = motion.t_s;
  if (!(t_s > times.front())) return motion.handle.front();
  if (t_s >= times.back()) return motion.handle.back();
  const auto k = std::size_t(std::ranges::upper_bound(times, t_s) - times.begin()) - 1;
  if (t_s == times[k]) return motion.handle[k];
  const double h = times[k + 1] - times[k];
  return on_cubics(motion.handle[k], motion.handle[k + 1], h, (times[k + 1] - t_s) / h,
                   (t_s - times[k]) / h);
}

laws::PalpationStep PalpationWalk::step(double t_s, const PalpationMotion& motion) noexcept {
  const auto answer =
      runtime_->recorded(between_samples(motion, t_s - runtime_->delay_s()), state_);
  ++steps_;
  not_converged_ += !answer.converged;
  return answer;
}

laws::PalpationStep PalpationWalk::to(double t_s, const PalpationMotion& motion) noexcept {
  if (steps_ > 0) {
    const std::uint64_t steps = palpation_steps(t_s_, t_s);
    const double width = t_s - t_s_;
    for (std::uint64_t s = 1; s < steps; ++s)
      step(t_s_ + width * double(s) / double(steps), motion);
  }
  t_s_ = t_s;
  return step(t_s, motion);
}

laws::PalpationStep PalpationStream::keep(double t_s, const HandleMotion& handle) {
  past_.t_s.push_back(t_s);
  past_.handle.push_back(handle);
  const auto answer = walk_.to(t_s, past_);
  forget();
  return answer;
}

/// Leaves the last two moments, and those about the earliest time that the next step asks for.
void PalpationStream::forget() {
  const double oldest_s = past_.t_s.back() - runtime_->delay_s();
  const std::ptrdiff_t forgotten =
      std::ranges::upper_bound(past_.t_s, oldest_s) - past_.t_s.begin() - 2;
  if (forgotten < kForgottenMoments) return;
  past_.t_s.erase(past_.t_s.begin(), past_.t_s.begin() + forgotten);
  past_.handle.erase(past_.handle.begin(), past_.handle.begin() + forgotten);
}

}  // namespace models
}  // namespace tractus
