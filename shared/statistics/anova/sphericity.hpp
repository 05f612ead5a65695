/// Contrasts of the levels of a within-subject factor, and Mauchly's test of what an analysis of variance assumes of them.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// An orthonormal basis of the contrasts of k levels, [level][contrast]: Helmert's, contrast j sets level j + 1 against the
/// mean of those before it.
Matrix contrasts(Eigen::Index k);

struct Mauchly {
  double w = 0.0, chi_squared = 0.0, df = 0.0;
  double p = 0.0;  ///< NaN for two levels (sphericity holds) or no more subjects than contrasts
};

/// Mauchly's criterion W of q contrasts, and the second-order expansion of the null distribution of −ν ρ ln W (Box 1949).
/// @param error  [contrast][contrast], sums of products within groups, or any multiple of them.
/// @param nu  degrees of freedom of `error`.
Mauchly mauchly(const Matrix& error, double nu);

}  // namespace tractus::statistics
