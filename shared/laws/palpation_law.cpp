#include "laws/palpation_law.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "laws/equilibrium.hpp"

namespace laws {
namespace {

using math::Pose;

struct Range {
  const char* name;
  double value, low, high;
};

}  // namespace

core::Result<PalpationLaw> PalpationLaw::make(const PalpationParameters& p,
                                              const volume::ForceField& field) {
  const Range ranges[] = {{"force_factor_Nm", p.force_factor_Nm, 0.0, 10.0},
                          {"force_scale", p.force_scale, 0.0, 100.0},
                          {"torque_scale", p.torque_scale, 0.0, 100.0},
                          {"points", double(p.points), 1.0, double(kMaxPoints)},
                          {"length_m", p.length_m, 1e-3, 2.0},
                          {"radius_m", p.radius_m, 1e-5, 0.1},
                          {"youngs_modulus_Pa", p.youngs_modulus_Pa, 1e3, 1e13},
                          {"point_spacing_m", p.point_spacing_m, 0.0,
                           p.points > 1 ? p.length_m / (p.points - 1) : 2.0}};
  for (const Range& range : ranges)
    if (!(range.value >= range.low && range.value <= range.high))
      return core::Error{core::Errc::out_of_range,
                         fmt::format("{}: {} is not within {} … {}", range.name, range.value,
                                     range.low, range.high)};
  return PalpationLaw(p, field);
}

PalpationLaw::PalpationLaw(const PalpationParameters& p, const volume::ForceField& field)
    : parameters_(p), field_(&field), z_m_{}, shape_{} {
  const double inertia_m4 = M_PI * std::pow(p.radius_m, 4) / 4.0;
  const double L = p.length_m;
  stiffness_N_per_m_ = 3.0 * p.youngs_modulus_Pa * inertia_m4 / (L * L * L);
  for (int i = 0; i < p.points; ++i) {
    const double z = std::max(L - i * p.point_spacing_m, 0.0);
    z_m_[std::size_t(i)] = z;
    shape_[std::size_t(i)] = z * z * (3.0 * L - z) / (2.0 * L * L * L);  // (4), 1 at the tip
  }
}

Vec3 PalpationLaw::point_H_m(int i, const Vec2& deflection_m) const noexcept {
  const auto k = std::size_t(i);
  return {shape_[k] * deflection_m.x(), shape_[k] * deflection_m.y(), z_m_[k]};
}

Vec3 PalpationLaw::tip_m(const Pose& X_VH, const Vec2& deflection_m) const noexcept {
  return X_VH * point_H_m(0, deflection_m);
}

PalpationStep PalpationLaw::step(const Pose& X_VH, PalpationState& state) const noexcept {
  PalpationStep out;
  const bool finite = X_VH.p.allFinite() && X_VH.q.coeffs().allFinite();
  if (!finite || !state.deflection_m.allFinite()) state.deflection_m.setZero();
  if (!finite) {  // no pose, no contact
    out.force_H_N.fill(Vec3::Zero());
    out.converged = false;
    return out;
  }
  const auto n = std::size_t(parameters_.points);
  const Beam beam{field_, parameters_.force_factor_Nm, stiffness_N_per_m_, std::span(z_m_).first(n),
                  std::span(shape_).first(n)};
  const Equilibrium found = equilibrium(beam, X_VH, state.deflection_m, out.force_H_N);
  state.deflection_m = out.deflection_m = found.deflection_m;
  out.iterations = found.iterations;
  out.converged = found.converged;
  for (std::size_t i = 0; i < n; ++i) {  // (3)
    const Vec3& F = out.force_H_N[i];
    out.wrench_H.force_N += F;
    out.wrench_H.torque_Nm += point_H_m(int(i), out.deflection_m).cross(F);
  }
  out.wrench_H.force_N *= parameters_.force_scale;
  out.wrench_H.torque_Nm *= parameters_.torque_scale;
  return out;
}

}  // namespace laws
