/// Robust regression: M-estimation with Tukey's bisquare, by iteratively reweighted least squares.
///
///     r = y − X b,  a_i = 1/√(1 − h_i),  u_i = a_i r_i / (c s),  w_i = (1 − u_i²)² for |u_i| < 1
///     s = median of |a r| without the (rank − 1) smallest / 0.6745
///     standard errors: DuMouchel & O'Brien 1989; Street, Carroll & Ruppert 1988
///
/// h_i are the leverages of the unweighted fit and stay fixed. The defaults are those of the tool
/// whose results the surgical literature prints (MATLAB's robustfit): c = 4.685, at most 50 solves,
/// relative change below √ε in every coefficient.
/// Known limit: a point alone at its x (leverage near 1) is not made harmless; look at the
/// leverage.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// Two programs' reading of the same estimator.
enum class BisquareConvention {
  matlab,  ///< as above
  mass  ///< R's MASS::rlm: no leverage factor, s = median |r| / 0.6745 of all, at most 20 solves,
  ///< ends when ‖r − r_before‖ ≤ 1e-4 ‖r_before‖; standard errors after Huber 1981, without
  ///< shrinking
};

struct BisquareOptions {
  BisquareConvention convention = BisquareConvention::matlab;
  double tuning = 4.685;
  int solves = 50;
  /// Floor of √ε = 1.49e-8 under every standard error, as the tool has it. Then t and p depend on
  /// the unit of y: leave it off except to reproduce.
  bool standard_error_floor = false;
};

struct Bisquare {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, t, p;
  double df_residual = 0.0;
  double ols_sigma = 0.0;     ///< of the least-squares start
  double mad_sigma = 0.0;     ///< of the final residuals
  double robust_sigma = 0.0;  ///< from the weights, before shrinking
  double sigma = 0.0;         ///< robust_sigma shrunk towards ols_sigma: what the tests use
  Matrix covariance;
  Vector weights, leverage, residuals;  ///< one per observation
  Vector studentised;                   ///< a_i r_i / sigma
  Vector ols_coefficients;
  int iterations = 0;  ///< entries of the loop: solves made, + 1 when it did not converge
  bool converged = false;
};

/// Errors: bad_input (check(), collinear columns by name); out_of_range where sums of squares leave
/// a double or too few observations keep a weight.
core::Result<Bisquare> bisquare(const Design& design, const Vector& response,
                                const BisquareOptions& options = {});

}  // namespace tractus::statistics
