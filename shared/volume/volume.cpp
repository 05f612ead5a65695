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
  std::array<int, 3> low{}, high{};
  Vec3 share;
  for (int a = 0; a < 3; ++a) {
    const int last = geometry.dims[std::size_t(a)] - 1;
    const double clamped = std::clamp(at[a], 0.0, double(last));
    low[std::size_t(a)] = std::min(int(clamped), std::max(last - 1, 0));
    high[std::size_t(a)] = std::min(low[std::size_t(a)] + 1, last);
    share[a] = clamped - low[std::size_t(a)];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const bool x = corner & 1, y = corner & 2, z = corner & 4;
    const double weight = (x ? share[0] : 1 - share[0]) * (y ? share[1] : 1 - share[1]) *
                          (z ? share[2] : 1 - share[2]);
    if (weight != 0.0)
      sum += weight * value(x ? high[0] : low[0], y ? high[1] : low[1], z ? high[2] : low[2]);
  }
  return sum;
}

}  // namespace tractus::volume
