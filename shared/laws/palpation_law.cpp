#include "laws/palpation_law.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/require.hpp"

namespace tractus {
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
    : parameters_(p), field_(&field), shank_(Shank::uniform(p)) {}

void PalpationLaw::replace_shank(const Shank& shank) {
  core::require(shank.points == shank_.points, "a shank keeps its contact points");
  shank_ = shank;
}

Vec3 PalpationLaw::point_H_m(int i, const Vec2& deflection_m) const noexcept {
  const auto k = std::size_t(i);
  const Vec2 across = shank_.shape[k] * deflection_m;
  if (shank_.straight) return {across.x(), across.y(), shank_.z_m[k]};
  return {across.x() + shank_.rest_m[k].x(), across.y() + shank_.rest_m[k].y(), shank_.z_m[k]};
}

Vec3 PalpationLaw::tip_m(const Pose& X_VH, const Vec2& deflection_m) const noexcept {
  return X_VH * point_H_m(0, deflection_m);
}

PalpationStep PalpationLaw::step(const Pose& X_VH, PalpationState& state,
                                 const ContactForces* contact) const noexcept {
  PalpationStep out;
  const bool finite = X_VH.p.allFinite() && X_VH.q.coeffs().allFinite();
  if (!finite || !state.deflection_m.allFinite()) state.deflection_m.setZero();
  if (!finite) {  // no pose, no contact
    out.force_H_N.fill(Vec3::Zero());
    out.converged = false;
    return out;
  }
  const auto n = std::size_t(parameters_.points);
  const Beam beam{field_, contact, parameters_.force_factor_Nm, &shank_};
  const Equilibrium found = equilibrium(beam, X_VH, state.deflection_m, out.force_H_N);
  state.deflection_m = out.deflection_m = found.deflection_m;
  out.iterations = found.iterations;
  out.converged = found.converged;
  for (std::size_t i = 0; i < n; ++i)  // (3)
    add_to_wrench(point_H_m(int(i), out.deflection_m), out.force_H_N[i], 1.0, 1.0, out.wrench_H);
  out.wrench_H.force_N *= parameters_.force_scale;
  out.wrench_H.torque_Nm *= parameters_.torque_scale;
  return out;
}

}  // namespace laws
}  // namespace tractus
