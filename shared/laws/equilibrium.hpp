/// Where a bent probe comes to rest in a force field.
#pragma once

#include <span>

#include "laws/shank.hpp"
#include "math/geometry.hpp"
#include "volume/force_field.hpp"

namespace tractus::laws {

/// A force and how it changes with the point it acts at, both in V.
struct ForceSample {
  math::Vec3 force_N;
  math::Mat3 jacobian_N_per_m;  ///< ∂F_a/∂p_b
};

/// What pushes on the contact points of a shank, where it is more than c_f g.
class ContactForces {
 public:
  virtual ~ContactForces() = default;
  /// The force on point i of the bent shank when it is at p. Never fails, never allocates.
  virtual ForceSample at(std::size_t i, const math::Vec3& p_V_m) const noexcept = 0;
};

/// A shank in what pushes on it, in symbols of PalpationLaw.
struct Beam {
  const volume::ForceField* field;
  const ContactForces* contact;  ///< null: c_f g alone
  double force_factor_Nm;        ///< c_f
  const Shank* shank;
};

struct Equilibrium {
  math::Vec2 deflection_m;  ///< δ, in H
  int iterations;           ///< how often the forces of all points were computed
  bool converged;           ///< |k δ − Σ φ F_⊥| < 0.001 N
};

/// The δ with  r(δ) = k δ − Σ φ(z_i) F_i,⊥(δ) = 0, near `start_m`, and F_i there in `force_H_N` (as
/// many as points).
///
/// Newton on r with a trust region. r is the gradient of ½ k δ² + c_f Σ (ω∗α)(p_i) where the field
/// is a potential; the fall of that energy over a step s is had from r and its derivative A at both
/// ends, −½ (r₀ + r₁)·s − sᵀ(A₀ − A₁)s/12, and a step is taken when some of what was promised comes
/// true. So the rest found is one the shank can stay in. The published field is no gradient, but
/// nearly; there the same expression is the work along the step.
/// At most 60 iterations; then the δ of least |r| met, with `converged` false. Never allocates.
Equilibrium equilibrium(const Beam& beam, const math::Pose& X_VH, const math::Vec2& start_m,
                        std::span<math::Vec3> force_H_N) noexcept;

}  // namespace tractus::laws
