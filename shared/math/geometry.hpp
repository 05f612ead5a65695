/// Points, poses and wrenches. Vectors carry frames in their names: p_VT is the point T seen from
/// V, X_VH the pose of H in V, f_H a force expressed in H. Units SI.
#pragma once

#include <Eigen/Geometry>

namespace tractus::math {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// Pose X_AB of a frame B in a frame A: p_A = p + q p_B. `q` is a unit quaternion.
struct Pose {
  Vec3 p = Vec3::Zero();  ///< origin of B in A, m
  Quat q = Quat::Identity();

  Vec3 operator*(const Vec3& p_B) const { return p + q * p_B; }
  Pose operator*(const Pose& X_BC) const { return {p + q * X_BC.p, q * X_BC.q}; }
  Pose inverse() const {
    const Quat r = q.conjugate();
    return {-(r * p), r};
  }
};

/// A force and a torque about the origin of the frame both are expressed in.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

}  // namespace tractus::math
