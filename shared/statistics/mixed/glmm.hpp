/// Logistic mixed model with a random intercept per group: answers of the same person go together.
///
///     logit π = X β + σ_u z_group,  z ~ N(0, 1),  y ~ Binomial(m, π)
///
/// Maximum likelihood; each group's integral by adaptive Gauss–Hermite quadrature with 50 nodes
/// about its mode, score and information as expectations over the same nodes (Louis 1982).
/// With ten people the normal z overstates what is known: read its p as a lower bound.
#pragma once

#include "statistics/regression/logistic.hpp"

namespace tractus::statistics {

struct Glmm {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, z, p;
  Matrix covariance;        ///< of the coefficients
  double sigma_u = 0.0;     ///< standard deviation between groups, on the logit scale; may be 0
  double sigma_u_se = 0.0;  ///< NaN where sigma_u is 0
  double log_likelihood = 0.0;
  std::vector<std::string> groups;
};

/// Errors: as logistic(); bad_input for one group; out_of_range where the likelihood has no maximum
/// (separated outcomes).
core::Result<Glmm> logistic_mixed(const Design& design, const Counts& counts,
                                  const std::vector<std::string>& labels);

}  // namespace tractus::statistics
