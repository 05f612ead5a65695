/// Where an eye is and what it sees, as geometry: no OpenXR, no OpenGL.
#pragma once

#include "math/geometry.hpp"

namespace tractus::headset {

/// Half angles of a view, signed: left and down are negative when the view reaches to both sides.
struct Fov {
  double left_rad = -0.7, right_rad = 0.7, up_rad = 0.7, down_rad = -0.7;
};

/// E: x to the right, y up, the eye looks along −z (as OpenXR and OpenGL have it).
struct Eye {
  math::Pose X_VE;
  Fov fov;
};

/// clip = P · (p_E, 1), with depth −1 at `near_m` and 1 at `far_m`; not symmetric where the view is
/// not.
///
///     P = [ 2/(r−l)  0        (r+l)/(r−l)   0          ]     l, r, d, u: tangents of the angles
///         [ 0        2/(u−d)  (u+d)/(u−d)   0          ]
///         [ 0        0        −(f+n)/(f−n)  −2fn/(f−n) ]
///         [ 0        0        −1            0          ]
Eigen::Matrix4d projection(const Fov& fov, double near_m, double far_m);

/// Where a point of the eye's frame comes to lie, from the lower left corner, in pixels.
math::Vec2 pixel_of(const math::Vec3& p_E_m, const Fov& fov, int width_px, int height_px);

/// Where the haptic device is taken to stand when nobody has aligned the room: its workspace's
/// centre at arm's length ahead of the head and below it, level, its x to the person.
/// @param X_SW  the head in the room's frame S (y up)
math::Pose device_ahead_of(const math::Pose& X_SW);

}  // namespace tractus::headset
