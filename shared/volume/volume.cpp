#include "volume/volume.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::volume {

std::uint16_t Volume::count_of(double value) const {
  return static_cast<std::uint16_t>(
      std::clamp(std::round((value - intercept) / slope), 0.0, 65535.0));
}

double Volume::value_at(const Vec3& p_V_m) const {
  const Vec3 at = geometry.index_of(p_V_m);
  std::array<int, 3> low{};
  std::array<std::size_t, 3> next{1, std::size_t(geometry.dims[0]),
                                  std::size_t(geometry.dims[0]) * std::size_t(geometry.dims[1])};
  std::array<double, 3> share{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int last = geometry.dims[a] - 1;
    const double clamped = std::clamp(at[int(a)], 0.0, double(last));
    low[a] = std::min(int(clamped), std::max(last - 1, 0));
    share[a] = clamped - low[a];
    if (low[a] == last) next[a] = 0;  // of one voxel along this axis
  }
  const auto along_x = [&](const std::uint16_t* from) {
    return (1.0 - share[0]) * from[0] + share[0] * from[next[0]];
  };
  const auto across_y = [&](const std::uint16_t* from) {
    return (1.0 - share[1]) * along_x(from) + share[1] * along_x(from + next[1]);
  };
  const std::uint16_t* corner = counts.data() + offset(low[0], low[1], low[2]);
  const double count = (1.0 - share[2]) * across_y(corner) + share[2] * across_y(corner + next[2]);
  return intercept + slope * count;
}

}  // namespace tractus::volume
