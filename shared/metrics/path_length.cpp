#include "metrics/path_length.hpp"

#include <cmath>

#include "math/savitzky_golay.hpp"

namespace tractus::metrics {

std::optional<double> smoothed_length_m(std::span<const math::Vec3> points_m, double dt_s) {
  const math::SavitzkyGolay slope(21, 3, 1);
  if (points_m.size() < std::size_t(slope.window())) return std::nullopt;
  std::vector<double> speed2(points_m.size(), 0.0), coordinate(points_m.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points_m.size(); ++i) coordinate[i] = points_m[i][axis];
    const auto velocity = slope.apply(coordinate, dt_s);
    for (std::size_t i = 0; i < velocity.size(); ++i) speed2[i] += velocity[i] * velocity[i];
  }
  double length_m = 0.0;
  for (std::size_t i = 1; i < speed2.size(); ++i)
    length_m += 0.5 * dt_s * (std::sqrt(speed2[i - 1]) + std::sqrt(speed2[i]));
  return length_m;
}

}  // namespace tractus::metrics
