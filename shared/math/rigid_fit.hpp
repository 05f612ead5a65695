/// One set of points laid onto another, and how far a set reaches.
#pragma once

#include <span>

#include "math/geometry.hpp"

namespace tractus::math {

/// The pose X_AB that carries points p_B onto p_A, one to one, by least squares over turns and translations
/// [Umeyama1991 with scale 1; Horn1987 asks the same]:
///
///     min over R, p:  Σ |p_A,i − (R p_B,i + p)|²
///
/// As many of both, three at least that are not on a line (`extents` tells); else one of several best turns.
Pose rigid_fit(std::span<const Vec3> p_A, std::span<const Vec3> p_B);

/// Root of the sum of squared distances from the centre along each principal axis, the longest first, in the points'
/// unit. The second is zero for points on a line, the third for points in a plane.
Vec3 extents(std::span<const Vec3> points);

}  // namespace tractus::math
