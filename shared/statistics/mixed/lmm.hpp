/// Linear mixed model with a random intercept per group: repeated trials of the same person.
///
///     y = X β + u_group + e,   u ~ N(0, τ²),  e ~ N(0, σ²)
///     REML criterion = (n − p)(1 + ln(2π RSS/(n − p))) + Σ ln(1 + n_i λ) + ln|Xᵀ V⁻¹ X|
///     with λ = τ²/σ²
///
/// Minimised in λ ≥ 0 by the root of its derivative, boundary included. Degrees of freedom after
/// Satterthwaite: 2v² / (gᵀ A g) with v = cᵀ cov(β) c, g its gradient in (τ², σ²), A twice the
/// inverse Hessian of the criterion (Fai & Cornelius 1996; the analytic Hessian). With τ² = 0 the
/// model is least squares on n − p degrees of freedom.
#pragma once

#include <array>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// What small-sample tests need beside the fit (lmm_tests.hpp), of θ = (τ², σ²),
/// V_1 = ZZᵀ, V_2 = I.
struct LmmCurvature {
  Matrix variance_covariance;  ///< of θ, from the observed information; no covariance where
                               ///< τ² = 0, at the edge
  std::array<Matrix, 2> covariance_slope;  ///< d cov(β)/dθ_a = Φ D_a Φ, D_a = Xᵀ V⁻¹ V_a V⁻¹ X
  Matrix expected_covariance;              ///< of θ, from the expected information
  Matrix bias;                             ///< Σ_ab W_ab (Q_ab − D_a Φ D_b), W the latter
};

struct Lmm {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, df, t, p;
  Matrix covariance;
  double tau_squared = 0.0;    ///< between groups
  double sigma_squared = 0.0;  ///< within
  double icc = 0.0;            ///< τ² / (τ² + σ²)
  double criterion = 0.0;      ///< −2 log REML likelihood
  double log_likelihood = 0.0;
  LmmCurvature curvature;  ///< empty where τ² = 0
  std::vector<std::string> groups;
  Vector group_effects;  ///< best linear unbiased predictions, one per group
  double rlrt = 0.0;     ///< restricted likelihood ratio of τ² = 0
  double rlrt_p = 0.0;   ///< with a 50:50 mixture of χ²(0) and χ²(1)
};

/// The same model by maximum likelihood: for comparing fixed effects.
struct LmmMl {
  Vector coefficients;
  double tau_squared = 0.0, sigma_squared = 0.0, deviance = 0.0, aic = 0.0, bic = 0.0;
};

/// @param labels  the group of each observation; at least two groups, one with two observations.
/// Errors: bad_input (check(), collinear columns by name, groups too few or single).
core::Result<Lmm> lmm(const Design& design, const Vector& response,
                      const std::vector<std::string>& labels);
core::Result<LmmMl> lmm_ml(const Design& design, const Vector& response,
                           const std::vector<std::string>& labels);

}  // namespace tractus::statistics
