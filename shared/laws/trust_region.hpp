/// The step of a trust-region Newton method in the plane.
#pragma once

#include "math/geometry.hpp"

namespace tractus::laws {

/// The s that minimises  r·s + ½ sᵀ A s  within |s| ≤ radius, A symmetric, definite or not
/// [Nocedal2006, section 4.3]. Finite for all finite input with radius > 0.
math::Vec2 trust_region_step(const math::Mat2& A, const math::Vec2& r, double radius) noexcept;

}  // namespace tractus::laws
