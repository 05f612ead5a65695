/// Small-sample tests of a linear mixed model's coefficients.
///
/// Satterthwaite (Fai & Cornelius 1996), of L β with cov L Φ Lᵀ = P diag(d) Pᵀ:
///
///     F = Σ t_m² / q,  ν_m = 2 d_m² / (g_mᵀ A g_m),  E = Σ_{ν_m > 2} ν_m/(ν_m − 2),
///     df = 2E/(E − q)
///
/// or after Kenward and Roger (kenward_roger.hpp).
///
/// With τ² = 0 the first is least squares on n − p degrees of freedom; the second goes on counting
/// the groups of the design.
#pragma once

#include "statistics/mixed/kenward_roger.hpp"
#include "statistics/mixed/lmm.hpp"
#include "statistics/regression/wald.hpp"

namespace tractus::statistics {

enum class SmallSample { satterthwaite, kenward_roger };

/// Are these coefficients all 0?
/// @param columns  which, at least one.
JointTest joint_test(const Lmm& fit, const std::vector<Eigen::Index>& columns, SmallSample how);

/// Satterthwaite's degrees of freedom of a contrast lᵀβ; n − p where τ² = 0.
/// @param contrast  l, one entry per coefficient.
double satterthwaite_df(const Lmm& fit, const Vector& contrast);

KenwardRoger kenward_roger(const Lmm& fit);

}  // namespace tractus::statistics
