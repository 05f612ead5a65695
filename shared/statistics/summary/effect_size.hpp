/// Differences of means with their size: t tests, Cohen's d, Hedges' g, intervals.
///
///     d = (x̄ − ȳ)/s_pooled,  g = J(m) d,  J(m) = Γ(m/2) / (√(m/2) Γ((m − 1)/2)), m the df of s
///     95 % interval of d: the noncentralities at which the observed t is the 97.5 and 2.5 % point
#pragma once

#include "statistics/distributions/proportions.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// Hedges' exact small-sample factor; below 1, for df ≥ 2.
double hedges_j(double df);

struct MeanDifference {
  double difference = 0.0, t = 0.0, df = 0.0, p = 0.0;
  Interval difference_95;
  double d = 0.0;  ///< pooled (two samples) or d_z (paired)
  double g = 0.0;  ///< d with J
  Interval d_95;
  double d_other =
      0.0;  ///< Glass' Δ by the sd of y (two samples); d_av by the root mean variance (paired)
};

/// Equal variances assumed. Errors: bad_input for fewer than two values each, or no spread.
core::Result<MeanDifference> two_samples(const Vector& x, const Vector& y);
/// x − y of the same subjects, in order.
core::Result<MeanDifference> paired(const Vector& x, const Vector& y);

struct WelchT {
  double t = 0.0, df = 0.0, p = 0.0;
  Interval difference_95;
};
/// Unequal variances.
core::Result<WelchT> welch_t(const Vector& x, const Vector& y);

struct Pearson {
  double r = 0.0, t = 0.0, df = 0.0, p = 0.0;
  Interval r_95;  ///< by Fisher's z; NaN for three pairs
};
/// Errors: bad_input for fewer than three pairs, or no spread.
core::Result<Pearson> pearson(const Vector& x, const Vector& y);

}  // namespace tractus::statistics
