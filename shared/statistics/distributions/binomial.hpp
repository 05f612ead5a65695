/// What the logistic models share: their likelihood's parts, and rows that are alike added up.
#pragma once

#include <optional>

#include "statistics/regression/logistic.hpp"

namespace tractus::statistics::binomial {

/// π = 1/(1 + e^−η) and ln(1 + e^η), both without overflow and from one exponential.
template <class Derived>
void parts(const Eigen::ArrayBase<Derived>& eta, typename Derived::PlainObject& pi,
           typename Derived::PlainObject& softplus) {
  using Array = typename Derived::PlainObject;
  const Array e = (-eta.abs()).exp(), u = 1.0 + e, log_u = u.log();  // each by itself: vectorised
  pi = (eta > 0.0).select(1.0 / u, e / u);
  // ln(1 + e) after Kahan: the quotient takes back what rounding 1 + e lost.
  softplus = eta.cwiseMax(0.0) + (u == 1.0).select(e, log_u * e / (u - 1.0));
}

/// π alone.
template <class Derived>
typename Derived::PlainObject inverse_logit(const Eigen::ArrayBase<Derived>& eta) {
  return 1.0 / (1.0 + (-eta).exp());
}

/// Σ ln of the binomial coefficients: the part of the log-likelihood that no parameter changes.
double log_coefficients(const Counts& counts);

/// Rows of the same columns as one row of more trials, in order of first appearance: the likelihood
/// keeps its shape, its maximum its place.
struct Merged {
  Matrix columns;
  Counts counts;
};
/// Nothing where it would save less than half of the rows.
std::optional<Merged> merged(const Matrix& columns, const Counts& counts);

}  // namespace tractus::statistics::binomial
