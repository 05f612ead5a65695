/// Several responses at once: do two groups differ, is a mean vector 0?
///
///     T² = n ȳᵀ S⁻¹ ȳ                        on p and n − p:          F = (n − p) T² / (p (n − 1))
///     T² = n₁ n₂/(n₁ + n₂) dᵀ S⁻¹ d          on p and n₁ + n₂ − p − 1: F = (N − p − 1) T² /
///                                                                          (p (N − 2))
///
/// Hotelling 1931. Of the differences between repeated measures it needs no sphericity, at the
/// price of power where there are few subjects. Assumes normal rows and, of two groups, equal
/// covariances.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Hotelling {
  double t_squared = 0.0;
  double f = 0.0, df1 = 0.0, df2 = 0.0, p = 0.0;
  double mahalanobis = 0.0;  ///< √(ȳᵀ S⁻¹ ȳ) or √(dᵀ S⁻¹ d): the distance in standard deviations
  Vector means;  ///< ȳ, or mean of the first less mean of the second
};

/// @param values  [observation][response], more rows than columns.
/// Errors: bad_input for fewer rows, a number that is not finite, responses that are constant or
/// determine one another, by name.
core::Result<Hotelling> hotelling(const Matrix& values, const std::vector<std::string>& names);
/// @param first, second  the same responses; more than p + 1 rows in all, two at least in each.
core::Result<Hotelling> hotelling(const Matrix& first, const Matrix& second,
                                  const std::vector<std::string>& names);

}  // namespace tractus::statistics
