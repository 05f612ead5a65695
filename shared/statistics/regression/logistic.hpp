/// Logistic regression of counts: recognised or not, wrong answers out of so many.
///
///     y_i ~ Binomial(m_i, π_i),  ln(π/(1 − π)) = X b
///     maximum likelihood by Newton's method; cov b = (Xᵀ W X)⁻¹, W = m π (1 − π), at the optimum
///     Firth 1993, Heinze & Schemper 2002:  U* = Xᵀ(y − m π + h(½ − π)),  h the leverages of √W X
///
/// Where the columns separate the outcomes there is no finite maximum: `logistic` says so, and
/// Firth's estimate remains finite. Assumes independent answers: those of one person are not.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// Successes out of trials, one per row of the design. 0 ≤ successes ≤ trials, trials ≥ 1.
struct Counts {
  Vector successes, trials;
};

struct Logistic {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, z, p;  ///< Wald
  Vector ci_low, ci_high;                      ///< 95 %, Wald
  Vector fitted;                               ///< π per row
  Matrix covariance;
  double deviance = 0.0, null_deviance = 0.0;
  double log_likelihood = 0.0, aic = 0.0;
  double lr_chi_squared = 0.0, lr_df = 0.0, lr_p = 0.0;  ///< against the intercept alone
  double df_residual = 0.0;
  double dispersion = 0.0;  ///< Pearson χ² / df: well above 1 means answers cluster
  int iterations = 0;
};

/// Errors: bad_input (a row that is no count, collinear columns by name, all outcomes equal);
/// out_of_range where the outcome is separated and no finite maximum exists.
core::Result<Logistic> logistic(const Design& design, const Counts& counts);

/// 95 % profile-likelihood interval of coefficient `j`. Errors: as logistic(); out_of_range where
/// the likelihood does not bound it.
core::Result<std::pair<double, double>> profile_interval(const Design& design, const Counts& counts,
                                                         const Logistic& fit, Eigen::Index j);

/// Quasi-binomial standard errors, t and p on df_residual: Wald widened by √dispersion.
struct QuasiBinomial {
  Vector standard_errors, t, p;
};
QuasiBinomial quasi_binomial(const Logistic& fit);

struct Firth {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, z, p, ci_low, ci_high;  ///< Wald
  Vector fitted;
  double penalised_log_likelihood = 0.0;  ///< without binomial coefficients
  int iterations = 0;
};

/// Errors: bad_input as logistic(); separated outcomes are fine.
core::Result<Firth> firth_logistic(const Design& design, const Counts& counts);

}  // namespace tractus::statistics
