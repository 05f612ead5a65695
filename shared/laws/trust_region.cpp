#include "laws/trust_region.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace laws {
namespace {

using math::Vec2;

/// Eigenvalues low ≤ high of a symmetric matrix and the unit eigenvector of the low one.
struct Eigen2 {
  double low, high;
  Vec2 along_low;
};

Eigen2 eigen(const math::Mat2& A) {
  const double mean = 0.5 * (A(0, 0) + A(1, 1)), half = 0.5 * (A(0, 0) - A(1, 1)), off = A(0, 1);
  const double spread = std::hypot(half, off);
  // Of the two expressions for the eigenvector, the one that does not cancel.
  Vec2 v = half >= 0.0 ? Vec2(-off, half + spread) : Vec2(spread - half, -off);
  const double norm = v.norm();
  v = norm > 0.0 ? Vec2(v / norm) : Vec2(1.0, 0.0);
  return {mean - spread, mean + spread, v};
}

/// The λ ≥ max(0, −low) for which |s(λ)| = radius, s_i = −r_i/(eigenvalue_i + λ). Newton on 1/|s|
/// rises to it from below without passing it; six rounds leave a step within 1e-6 of the radius,
/// far closer than a radius is known.
double damping(const Eigen2& e, double r_low, double r_high, double radius) {
  double lambda =
      std::max({0.0, std::abs(r_low) / radius - e.low, std::abs(r_high) / radius - e.high});
  for (int round = 0; round < 6; ++round) {
    const double a = e.low + lambda, b = e.high + lambda;
    if (!(a > 0.0 && b > 0.0)) break;
    const double s2 = r_low * r_low / (a * a) + r_high * r_high / (b * b);
    const double slope = r_low * r_low / (a * a * a) + r_high * r_high / (b * b * b);
    if (!(s2 > radius * radius * (1.0 + 1e-9)) || !(slope > 0.0)) break;
    lambda += s2 / slope * (std::sqrt(s2) / radius - 1.0);
  }
  return lambda;
}

}  // namespace

Vec2 trust_region_step(const math::Mat2& A, const Vec2& r, double radius) noexcept {
  const Eigen2 e = eigen(A);
  const Vec2 along_high(-e.along_low.y(), e.along_low.x());
  const double r_low = r.dot(e.along_low), r_high = r.dot(along_high);
  if (e.low > 0.0) {
    const Vec2 newton = -r_low / e.low * e.along_low - r_high / e.high * along_high;
    if (newton.squaredNorm() <= radius * radius) return newton;
  }
  const double lambda = damping(e, r_low, r_high, radius);
  const double a = e.low + lambda, b = e.high + lambda;
  const double s_high = b > 0.0 ? -r_high / b : 0.0;
  // The hard case: nothing pushes along the falling direction. Either way along it falls; take one
  // to the boundary.
  const double room = std::sqrt(std::max(radius * radius - s_high * s_high, 0.0));
  const double s_low = a > 0.0 ? std::clamp(-r_low / a, -room, room) : room;
  return s_low * e.along_low + std::clamp(s_high, -radius, radius) * along_high;
}

}  // namespace laws
}  // namespace tractus
