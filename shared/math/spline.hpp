/// Natural cubic splines, and motion through recorded poses.
#pragma once

#include <span>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::math {

/// The natural cubic spline (second derivative zero at both ends) through (t_k, y_k).
class CubicSpline {
 public:
  /// @param t  s, strictly increasing, at least two. Errors: bad_input.
  static core::Result<CubicSpline> make(std::span<const double> t, std::span<const double> y);
  /// Outside the knots the end polynomials go on.
  double value(double t) const noexcept;
  double derivative(double t) const noexcept;
  double second_derivative(double t) const noexcept;

 private:
  struct At {
    std::size_t k;
    double h, a, b;  // of the interval: width, weights of its left and right knot
  };
  At at(double t) const noexcept;
  std::vector<double> t_, y_, m_;  // m: second derivatives at the knots
};

/// Motion through recorded poses: position by a natural cubic spline per axis; orientation by one
/// per component of the quaternions, made continuous in sign, normalised at the end (ADR-0003).
class PoseSpline {
 public:
  static core::Result<PoseSpline> make(std::span<const double> t, std::span<const Pose> X);
  Pose pose(double t) const noexcept;
  Vec3 velocity_m_s(double t) const noexcept;
  Vec3 acceleration_m_s2(double t) const noexcept;
  /// Angular velocity in the frame the poses are seen from, rad/s.
  Vec3 angular_velocity_rad_s(double t) const noexcept;
  /// Its derivative, in the same frame, rad/s².
  Vec3 angular_acceleration_rad_s2(double t) const noexcept;

 private:
  std::vector<CubicSpline> p_, q_;  // x y z; w x y z
};

}  // namespace tractus::math
