/// The palpation of a drilled tract with a bending probe: from the pose of the handle to what the
/// bone does to it.
#pragma once

#include <array>
#include <span>

#include "core/result.hpp"
#include "laws/equilibrium.hpp"
#include "laws/shank.hpp"
#include "math/geometry.hpp"
#include "volume/force_field.hpp"

namespace tractus::laws {

using math::Vec2;
using math::Vec3;

/// The numbers of [Zoller2020]; field names are those of the model file (`/base`).
struct PalpationParameters {
  double force_factor_Nm =
      0.005;  ///< c_f, eq. (2). The paper prints "5 Nm"; only 5 N·mm gives its own maxima
  double force_scale = 0.3;   ///< s_f, eq. (3)
  double torque_scale = 0.3;  ///< s_t, eq. (3)
  int points = 3;             ///< n, 1 … 64
  double point_spacing_m = 0.009;
  double youngs_modulus_Pa = 1.95e11;  ///< E
  double length_m = 0.13;              ///< L
  double radius_m = 0.0007;            ///< r; I = π r⁴ / 4
  Vec3 pose_offset_m = Vec3::Zero();   ///< added to the recorded position, in V
};

/// What changes from tick to tick. A fresh one is the unbent probe.
struct PalpationState {
  Vec2 deflection_m = Vec2::Zero();  ///< δ of the tip, in H
};

struct PalpationStep {
  math::Wrench wrench_H;  ///< F*, τ*: what the bone does to the probe, at the handle's origin, in H
  Vec2 deflection_m = Vec2::Zero();  ///< δ
  int iterations = 0;
  bool converged = true;  ///< |k δ − Σ φ F| < 0.001 N was reached
  std::array<Vec3, kMaxPoints>
      force_H_N;  ///< F_i at each point, before scaling, in H; the first `points` are set
};

/// Adds what a force on one point of the probe does to the handle's origin, a term of eq. (3):
/// s_f F to the force, s_t p × F to the torque. All in H.
inline void add_to_wrench(const Vec3& point_m, const Vec3& force_N, double force_scale,
                          double torque_scale, math::Wrench& wrench) noexcept {
  wrench.force_N += force_scale * force_N;
  wrench.torque_Nm += torque_scale * point_m.cross(force_N);
}

/// The law of palpation [Zoller2020, eqs (2) to (4)]: how the bone pushes on a bending probe.
///
///     p_i = X_VH (z_i ẑ + φ(z_i) (δx x̂ + δy ŷ)),   z_i = L − i·spacing,   φ(z) = z²(3L − z)/(2L³)
///     F_i = c_f g(p_i)                                                 (2)
///     F* = s_f Σ F_i,   τ* = s_t Σ (p_i − origin) × F_i                (3)
///     k δ = Σ φ(z_i) F_i,⊥,   k = 3EI/L³   (to < 0.001 N)              (4)
///
/// (4) is the published v(z) = F z²(3L − z)/(6EI) with δ = v(L) as the unknown: v(z) = δ φ(z).
/// Assumes small deflections, a straight uniform shank, contact at the n points alone. A model's
/// effects replace two parts: the Shank (structure), and ContactForces instead of F_i = c_f g(p_i).
/// Departs from the source: the equilibrium is found by Newton with a trust region instead of
/// relaxation (which fails to converge where the wall is stiffer than the shank), to the same
/// tolerance.
class PalpationLaw {
 public:
  /// Errors: out_of_range naming the first parameter outside its range. `field` must outlive the
  /// law.
  static core::Result<PalpationLaw> make(const PalpationParameters& parameters,
                                         const volume::ForceField& field);

  /// One step from the handle's pose in V. Never fails, never allocates. `state` is the last
  /// step's.
  /// @param contact  what pushes on the points; null: F_i = c_f g(p_i)
  PalpationStep step(const math::Pose& X_VH, PalpationState& state,
                     const ContactForces* contact = nullptr) const noexcept;

  /// Tip of the bent probe in V, m.
  Vec3 tip_m(const math::Pose& X_VH, const Vec2& deflection_m) const noexcept;
  /// Contact point i of the bent probe in H, m.
  Vec3 point_H_m(int i, const Vec2& deflection_m) const noexcept;
  const PalpationParameters& parameters() const noexcept { return parameters_; }
  /// k, 3EI/L³ where the shank is uniform, N/m.
  double tip_stiffness_N_per_m() const noexcept { return shank_.stiffness_N_per_m; }
  const Shank& shank() const noexcept { return shank_; }
  /// Puts another shank in the place of the uniform one: as many points as before.
  void replace_shank(const Shank& shank);

 private:
  PalpationLaw(const PalpationParameters& parameters, const volume::ForceField& field);
  PalpationParameters parameters_;
  const volume::ForceField* field_;
  Shank shank_;
};

}  // namespace tractus::laws
