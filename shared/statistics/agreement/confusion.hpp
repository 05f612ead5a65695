/// What was there against what was said: agreement beyond chance, and per class.
///
///     κ = (p_o − p_e)/(1 − p_e), standard error after Fleiss, Cohen & Everitt 1969
///
/// A class that was never said has precision and F1 of 0 (0/0 by convention).
#pragma once

#include "statistics/distributions/proportions.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Confusion {
  double total = 0.0, accuracy = 0.0, expected_agreement = 0.0;
  Interval accuracy_95;  ///< Clopper–Pearson
  double kappa = 0.0, kappa_se = 0.0, kappa_se_null = 0.0;
  Interval kappa_95;
  double kappa_linear = 0.0, kappa_quadratic = 0.0;  ///< weighted: only for ordered classes
  Vector precision, recall, specificity, f1;         ///< per class
  double macro_precision = 0.0, balanced_accuracy = 0.0, macro_f1 = 0.0, weighted_f1 = 0.0;
  double mcc = 0.0;                  ///< Gorodkin's R_K
  double no_information_rate = 0.0;  ///< share of the commonest true class
  double p_above_no_information = 0.0;
  double mutual_information_bits = 0.0;
  double bowker = 0.0;  ///< χ² of symmetry of the errors
};

/// @param counts  [truth][response], square, whole, ≥ 0, not all 0.
/// Errors: bad_input; and where only one class occurs on both sides, κ being 0/0.
core::Result<Confusion> confusion(const Matrix& counts);

}  // namespace tractus::statistics
