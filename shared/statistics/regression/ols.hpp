/// Ordinary least squares with everything its reader needs: tests, intervals, diagnostics.
///
///     y = X b + e,   b = argmin ‖y − X b‖²,   s² = ‖y − X b‖² / (n − p)
///     cov b = s² (XᵀX)⁻¹,   t_j = b_j / se_j on n − p degrees of freedom
///
/// Column-pivoted Householder QR of the centred, scaled columns (of X itself without an intercept).
/// Up to 200 000 numbers in X it is computed in 80-bit arithmetic, beyond that in double, by
/// normal equations in blocks where the columns are far enough from collinear for them.
/// Known limit: a design whose scaled columns depend on each other to 1e-13 is refused.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Ols {
  std::vector<std::string> names;  ///< of the coefficients, in the order of the design
  Vector coefficients, standard_errors, t, p;
  Vector ci_low, ci_high;      ///< 95 %
  Matrix unscaled_covariance;  ///< (XᵀX)⁻¹
  double df_residual = 0.0;
  double sigma = 0.0;  ///< residual standard deviation s
  double rss = 0.0;    ///< residual sum of squares
  double r_squared = 0.0, adjusted_r_squared = 0.0;
  double f = 0.0, f_df1 = 0.0, f_p = 0.0;  ///< of the whole model (NaN with an intercept alone)
  double log_likelihood = 0.0, aic = 0.0, bic = 0.0;
  Vector residuals;  ///< one per observation; fitted values are the response less these
  Vector leverage;   ///< h_i, diagonal of the hat matrix
};

/// What one observation does to a fit (Belsley, Kuh & Welsch 1980; Cook 1977). One entry per
/// observation; NaN where h_i = 1.
struct Influence {
  Vector standardised;  ///< r_i / (s √(1 − h_i))
  Vector studentised;   ///< the same with s from the fit without i
  Vector cooks_distance;
  Vector dffits;
};

/// Errors: bad_input (check(), or columns that are collinear, by name), out_of_range when a result
/// leaves the range of a double.
core::Result<Ols> ols(const Design& design, const Vector& response);

Influence influence(const Ols& fit);

/// Heteroscedasticity-consistent standard errors HC3 (MacKinnon & White 1985):
/// (XᵀX)⁻¹ Xᵀ diag(r_i² / (1 − h_i)²) X (XᵀX)⁻¹.
Vector hc3_standard_errors(const Design& design, const Ols& fit);

}  // namespace tractus::statistics
