#include "bench/haptic_step/published_relaxation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tractus::bench {

using math::Vec2;
using math::Vec3;

PublishedRelaxation::PublishedRelaxation(const volume::Volume& volume,
                                         const volume::ForceField& field,
                                         const laws::PalpationParameters& parameters,
                                         double gain_m_per_N)
    : geometry_(volume.geometry), parameters_(parameters), gain_m_per_N_(gain_m_per_N) {
  g_.reserve(geometry_.voxel_count());
  for (int k = 0; k < geometry_.dims[2]; ++k)
    for (int j = 0; j < geometry_.dims[1]; ++j)
      for (int i = 0; i < geometry_.dims[0]; ++i) {
        const Vec3 g = field.gradient_per_m(geometry_.position_of(Vec3(i, j, k)));
        g_.push_back({float(g.x()), float(g.y()), float(g.z())});
      }
}

Vec3 PublishedRelaxation::gradient_per_m(const Vec3& p_V_m) const {
  const Vec3 u = geometry_.index_of(p_V_m);
  std::array<std::array<float, 4>, 3> w{};
  std::array<int, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double floor = std::floor(u[Eigen::Index(a)]);
    const auto t = float(u[Eigen::Index(a)] - floor);
    cell[a] = int(std::clamp(floor, -1e6, 1e6));
    w[a] = {0.5f * (-t * t * t + 2 * t * t - t), 0.5f * (3 * t * t * t - 5 * t * t + 2),
            0.5f * (-3 * t * t * t + 4 * t * t + t), 0.5f * (t * t * t - t * t)};
  }
  Vector sum{0, 0, 0};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const int x = std::clamp(cell[0] - 1 + i, 0, geometry_.dims[0] - 1);
        const int y = std::clamp(cell[1] - 1 + j, 0, geometry_.dims[1] - 1);
        const int z = std::clamp(cell[2] - 1 + k, 0, geometry_.dims[2] - 1);
        const float weight = w[0][std::size_t(i)] * w[1][std::size_t(j)] * w[2][std::size_t(k)];
        const Vector& g = g_[(std::size_t(z) * std::size_t(geometry_.dims[1]) + std::size_t(y)) *
                                 std::size_t(geometry_.dims[0]) +
                             std::size_t(x)];
        sum.x += weight * g.x;
        sum.y += weight * g.y;
        sum.z += weight * g.z;
      }
  return {sum.x, sum.y, sum.z};
}

laws::PalpationStep PublishedRelaxation::step(const math::Pose& X_VH,
                                              laws::PalpationState& state) const {
  const auto& p = parameters_;
  const double L = p.length_m;
  const double k = 3.0 * p.youngs_modulus_Pa * (M_PI * std::pow(p.radius_m, 4) / 4.0) / (L * L * L);
  laws::PalpationStep out;
  out.converged = false;
  for (out.iterations = 1; out.iterations <= 1000; ++out.iterations) {
    Vec2 at_tip = -k * state.deflection_m;
    out.wrench_H = {};
    for (int i = 0; i < p.points; ++i) {
      const double z = L - i * p.point_spacing_m;
      const double shape = z * z * (3 * L - z) / (2 * L * L * L);
      const Vec3 p_H(shape * state.deflection_m.x(), shape * state.deflection_m.y(), z);
      const Vec3 F = p.force_factor_Nm * (X_VH.q.conjugate() * gradient_per_m(X_VH * p_H));
      at_tip += shape * F.head<2>();
      out.wrench_H.force_N += p.force_scale * F;
      out.wrench_H.torque_Nm += p.torque_scale * p_H.cross(F);
    }
    if (at_tip.norm() < 0.001) {
      out.converged = true;
      break;
    }
    state.deflection_m += gain_m_per_N_ * at_tip;
  }
  out.deflection_m = state.deflection_m;
  return out;
}

}  // namespace tractus::bench
