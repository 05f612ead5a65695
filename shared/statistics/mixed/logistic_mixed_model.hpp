/// Logistic mixed model with any number of random terms, crossed or nested, intercepts and slopes.
///
///     logit π = X β + Σ_t Z_t b_t,   b_t of each level ~ N(0, Σ_t),   y ~ Binomial(m, π)
///     Σ_t = Λ_t Λ_tᵀ, Λ_t lower triangular with the entries θ
///
/// Maximum likelihood by Laplace's approximation (laplace.hpp), as lme4's glmer has it with nAGQ = 1:
/// d(θ, β) is minimised over both. The covariance of β is that part of 2 H⁻¹, H the second derivatives
/// of d in (θ, β). As in mixed_model.hpp the minimum has no bounds and a singular estimate is said.
///
/// Known limit: Laplace's approximation is exact as the answers of each level become many. Of a
/// few yes-or-no answers a level it makes the variances, and with them the odds ratios, too small
/// [Breslow1993]; for one random intercept logistic_mixed() (glmm.hpp) has no such bias.
#pragma once

#include "core/progress.hpp"
#include "statistics/mixed/random_term.hpp"
#include "statistics/regression/logistic.hpp"

namespace tractus::statistics {

struct LogisticMixedModel {
  std::vector<std::string> names;
  Vector coefficients, standard_errors, z, p;  ///< Wald
  Vector ci_low, ci_high;                      ///< 95 %, Wald
  Matrix covariance;                           ///< of the coefficients
  double log_likelihood = 0.0, aic = 0.0;
  int parameters = 0;  ///< β and θ
  std::vector<RandomPart> random;
  bool singular = false;   ///< some Σ_t has no full rank
  bool converged = false;  ///< the minimum was reached to the digits that rounding leaves
};

/// Errors: as logistic(); bad_input for a grouping of one level or with a level for each answer;
/// out_of_range where the outcomes are separated by levels and the likelihood has no maximum;
/// cancelled.
core::Result<LogisticMixedModel> logistic_mixed_model(const Design& design, const Counts& counts,
                                                      const std::vector<RandomTerm>& terms,
                                                      const core::Progress& progress = {});

}  // namespace tractus::statistics
