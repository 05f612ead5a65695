/// Linear mixed model with any number of random terms, crossed or nested, intercepts and slopes.
///
///     y = X β + Σ_t Z_t b_t + e,   b_t of each level ~ N(0, Σ_t),   e ~ N(0, σ²)
///     Σ_t = σ² Λ_t Λ_tᵀ, Λ_t lower triangular with the entries θ
///
/// The criterion is profiled in β and σ² and evaluated by one sparse Cholesky factorisation
/// [Bates2015, section 3]:
///
///     [ΛᵀZᵀZΛ + I, ΛᵀZᵀX; XᵀZΛ, XᵀX] = [L 0; R_ZXᵀ R_Xᵀ] [Lᵀ R_ZX; 0 R_X]
///     ML:   ln|L|² + n (1 + ln(2π r²/n))
///     REML: ln|L|² + ln|R_X|² + (n − p)(1 + ln(2π r²/(n − p))),   r² the penalised residual sum
///
/// It is even in the sign of each column of Λ, so that it is minimised over θ without bounds; an
/// estimate at the edge (a variance of 0, a correlation of ±1) is a minimum like others and is said
/// (`singular`). Degrees of freedom after Satterthwaite from numeric second derivatives in (θ, σ), as
/// lmerTest computes them [Kuznetsova2017]; at the edge directions without curvature are left out.
#pragma once

#include <string>
#include <vector>

#include "core/progress.hpp"
#include "statistics/mixed/random_term.hpp"
#include "statistics/regression/wald.hpp"

namespace tractus::statistics {

enum class Likelihood { reml, ml };

struct MixedModel {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, df, t, p;
  Matrix covariance;
  double sigma_squared = 0.0;
  double criterion = 0.0;  ///< −2 log likelihood, restricted with REML
  int parameters = 0;      ///< β, θ and σ
  std::vector<RandomPart> random;
  bool singular = false;   ///< some Σ_t has no full rank
  bool converged = false;  ///< the minimum was reached to the digits that rounding leaves
  // For contrasts (mixed_df): d cov(β)/d(θ, σ), and twice the inverse Hessian of the criterion.
  std::vector<Matrix> covariance_slope;
  Matrix parameter_covariance;
};

/// Errors: bad_input (check(), collinear columns by name, a grouping of one level or with a level
/// for each observation, more effects than observations can tell), out_of_range (numbers too large
/// or small), cancelled.
core::Result<MixedModel> mixed_model(const Design& design, const Vector& response,
                                     const std::vector<RandomTerm>& terms,
                                     Likelihood likelihood = Likelihood::reml,
                                     const core::Progress& progress = {});

/// Satterthwaite's degrees of freedom of a contrast lᵀβ.
double mixed_df(const MixedModel& fit, const Vector& contrast);
/// Are these coefficients all 0? F after Fai and Cornelius (lmm_tests.hpp).
JointTest joint_test(const MixedModel& fit, const std::vector<Eigen::Index>& columns);

}  // namespace tractus::statistics
