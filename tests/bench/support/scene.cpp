#include "bench/support/scene.hpp"

#include <array>
#include <cmath>

namespace tractus {
namespace bench {
namespace {

using math::Vec3;

constexpr double kSpacing_m = 0.00035;
constexpr double kSurface_m = 0.020, kLength_m = 0.040, kRadius_m = 0.0015;
constexpr double kProbe_m = 0.13;

Vec3 axis() { return Vec3(0.10, -0.06, 1.0).normalized(); }
Vec3 entry() { return {0.028, 0.028, kSurface_m}; }

/// A number in −1 … 1 from a lattice point.
double lattice(int i, int j, int k) {
  auto h = std::uint32_t(i) * 374761393u + std::uint32_t(j) * 668265263u +
           std::uint32_t(k) * 2246822519u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return double(h ^ (h >> 16)) / 2147483648.0 - 1.0;
}

/// The lattice's numbers, trilinear between its points.
double soft_noise(double x, double y, double z) {
  const int i = int(std::floor(x)), j = int(std::floor(y)), k = int(std::floor(z));
  const double fx = x - i, fy = y - j, fz = z - k;
  double sum = 0.0;
  for (int c = 0; c < 8; ++c)
    sum += ((c & 1) ? fx : 1 - fx) * ((c & 2) ? fy : 1 - fy) * ((c & 4) ? fz : 1 - fz) *
           lattice(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1));
  return sum;
}

}  // namespace

volume::Volume tract_block() {
  volume::Volume v;
  v.geometry.dims = {160, 160, 200};
  v.geometry.spacing_m = Vec3::Constant(kSpacing_m);
  v.intercept = -1024.0;
  v.counts.reserve(v.geometry.voxel_count());
  for (int k = 0; k < 200; ++k)
    for (int j = 0; j < 160; ++j)
      for (int i = 0; i < 160; ++i) {
        const Vec3 p = kSpacing_m * Vec3(i, j, k);
        const double depth = (p - entry()).dot(axis());
        const double off = ((p - entry()) - depth * axis()).norm();
        const bool air = p.z() < kSurface_m || (depth < kLength_m && off < kRadius_m);
        const double bone = 500.0 + 350.0 * soft_noise(i / 3.1, j / 3.1, k / 3.1);
        v.counts.push_back(v.count_of(air ? -1000.0 : bone));
      }
  return v;
}

math::Pose palpating_hand(double t) {
  const double tapping = std::fmod(t, 4.0) > 3.0 ? 1.0 : 0.0;
  const double stroke = 0.021 + 0.016 * std::sin(2 * M_PI * 0.7 * t);
  const double tap = kLength_m + 0.0008 * std::sin(2 * M_PI * 2.3 * t) - 0.0002;
  const double depth = tapping > 0 ? tap : stroke;
  const double around = 2 * M_PI * 0.13 * t;
  const double press_m =
      0.004 * (1.0 + std::sin(2 * M_PI * 1.1 * t));  // of the handle against the tract's axis
  const double tilt_rad = 0.03 * std::sin(2 * M_PI * 0.37 * t);
  const Vec3 tremor = 30e-6 * Vec3(std::sin(2 * M_PI * 9.1 * t), std::sin(2 * M_PI * 10.3 * t + 1),
                                   std::sin(2 * M_PI * 8.7 * t + 2));
  const math::Quat along = math::Quat::FromTwoVectors(Vec3::UnitZ(), axis());
  const math::Quat tilted(
      Eigen::AngleAxisd(tilt_rad, Vec3(std::cos(1.7 * t), std::sin(1.7 * t), 0)));
  const math::Quat rolled(Eigen::AngleAxisd(0.8 * std::sin(0.9 * t), Vec3::UnitZ()));
  const math::Quat q = along * tilted * rolled;
  // The tip of the straight shank would lie in the tract's axis but for the press, which pushes all
  // of it sideways.
  const Vec3 tip = entry() + depth * axis() +
                   along * (press_m * Vec3(std::cos(around), std::sin(around), 0)) + tremor;
  return {tip - kProbe_m * (q * Vec3::UnitZ()), q};
}

volume::Volume noise_block(int nx, int ny, int nz) {
  volume::Volume v;
  v.geometry.dims = {nx, ny, nz};
  v.geometry.spacing_m = Vec3::Constant(kSpacing_m);
  v.intercept = -1024.0;
  v.counts.resize(v.geometry.voxel_count());
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        v.counts[v.offset(i, j, k)] =
            std::uint16_t(1400 + 500 * std::sin(0.11 * i) * std::cos(0.07 * j + 0.05 * k) +
                          60 * lattice(i, j, k));
  return v;
}

}  // namespace bench
}  // namespace tractus
