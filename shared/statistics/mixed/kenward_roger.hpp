/// Small-sample tests of a mixed model's coefficients after Kenward and Roger.
///
/// For a covariance V linear in its parameters σ_a, V_a = dV/dσ_a, of Φ = (Xᵀ V⁻¹ X)⁻¹
/// [Kenward1997; Halekoh2014, section 6]:
///
///     D_a = Xᵀ V⁻¹ V_a V⁻¹ X,  Q_ab = Xᵀ V⁻¹ V_a V⁻¹ V_b V⁻¹ X
///     W = 2 I⁻¹,  I_ab = tr(V⁻¹V_aV⁻¹V_b) − 2 tr(Φ Q_ab) + tr(Φ D_a Φ D_b)
///     Φ_A = Φ + 2 Φ [Σ W_ab (Q_ab − D_a Φ D_b)] Φ;   Θ = Lᵀ (L Φ Lᵀ)⁻¹ L
///     A_1 = Σ W_ab tr(ΘΦD_aΦ) tr(ΘΦD_bΦ),  A_2 = Σ W_ab tr(ΘΦD_aΦ ΘΦD_bΦ)
///     F = (λ/q) (Lβ)ᵀ (L Φ_A Lᵀ)⁻¹ Lβ on q and m degrees of freedom, λ and m from A_1 and A_2
///
/// Of a model with any random terms all this is computed from matrices of the size of its random
/// effects, V⁻¹ = (I − Z H Zᵀ)/σ², so that it takes many rows but not many levels.
#pragma once

#include "statistics/mixed/mixed_model.hpp"

namespace tractus::statistics {

/// Each coefficient's test, with standard errors from Φ_A.
struct KenwardRoger {
  Vector coefficients, standard_errors, df, t, p;
  Matrix covariance;  ///< Φ_A
  // For joint tests.
  Matrix unadjusted;                     ///< Φ
  std::vector<Matrix> covariance_slope;  ///< Φ D_a Φ
  Matrix parameter_covariance;           ///< W
};

/// What a fit gives. @param bias  Σ W_ab (Q_ab − D_a Φ D_b)
KenwardRoger kenward_roger(const Vector& coefficients, const Matrix& covariance,
                           const std::vector<Matrix>& covariance_slope,
                           const Matrix& parameter_covariance, const Matrix& bias);

/// Of a model fitted by restricted maximum likelihood to this design and these terms.
/// Errors: bad_input where it has more random effects than can be inverted here.
core::Result<KenwardRoger> kenward_roger(const MixedModel& fit, const Design& design,
                                         const std::vector<RandomTerm>& terms);

/// Are these coefficients all 0?
/// @param columns  which, at least one.
JointTest joint_test(const KenwardRoger& tests, const std::vector<Eigen::Index>& columns);

}  // namespace tractus::statistics
