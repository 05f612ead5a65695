#include "station/headset/eyes.hpp"

#include <cmath>

namespace tractus::headset {
namespace {
constexpr double kAhead_m = 0.45, kBelow_m = 0.22;
}

Eigen::Matrix4d projection(const Fov& fov, double near_m, double far_m) {
  const double l = std::tan(fov.left_rad), r = std::tan(fov.right_rad);
  const double d = std::tan(fov.down_rad), u = std::tan(fov.up_rad);
  Eigen::Matrix4d P = Eigen::Matrix4d::Zero();
  P(0, 0) = 2.0 / (r - l);
  P(0, 2) = (r + l) / (r - l);
  P(1, 1) = 2.0 / (u - d);
  P(1, 2) = (u + d) / (u - d);
  P(2, 2) = -(far_m + near_m) / (far_m - near_m);
  P(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  P(3, 2) = -1.0;
  return P;
}

math::Vec2 pixel_of(const math::Vec3& p_E_m, const Fov& fov, int width_px, int height_px) {
  const double l = std::tan(fov.left_rad), r = std::tan(fov.right_rad);
  const double d = std::tan(fov.down_rad), u = std::tan(fov.up_rad);
  const double across = -p_E_m.x() / p_E_m.z(), up = -p_E_m.y() / p_E_m.z();
  return {width_px * (across - l) / (r - l), height_px * (up - d) / (u - d)};
}

math::Pose device_ahead_of(const math::Pose& X_SW) {
  math::Vec3 ahead = X_SW.q * -math::Vec3::UnitZ();
  ahead.y() = 0.0;
  // Somebody who looks straight up or down: where the top of the head, or the feet, point.
  if (ahead.norm() < 0.1) {
    ahead = X_SW.q * math::Vec3::UnitY();
    ahead.y() = 0.0;
    if ((X_SW.q * -math::Vec3::UnitZ()).y() > 0.0) ahead = -ahead;
  }
  ahead.normalize();
  math::Mat3 R;
  R.col(0) = -ahead;
  R.col(2) = math::Vec3::UnitY();
  R.col(1) = R.col(2).cross(R.col(0));
  return {X_SW.p + kAhead_m * ahead - kBelow_m * math::Vec3::UnitY(), math::Quat(R)};
}

}  // namespace tractus::headset
