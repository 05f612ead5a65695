/// A bound for a score, from the scores of people who can and of people who learn.
///
///     mean + k·SD            with k = 0 the experts' mean of proficiency-based training
///                            (Gallagher2005)
///     percentile             linear between order statistics, h = (n − 1)p (Hyndman1996, type 7)
///     greatest Youden index  J = sensitivity + specificity − 1 (Youden1950)
///
/// Trials of one person are not independent: a bound from many trials of few people is less certain
/// than the number of trials suggests.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// mean + k · standard deviation (with n − 1). Errors: bad_input for fewer than two values.
core::Result<double> mean_bound(const Vector& values, double k);

/// @param share  0 … 1. Errors: bad_input for no value or a share outside.
core::Result<double> percentile(const Vector& values, double share);

/// Which side of a bound passes.
enum class Passing { at_most, at_least };

struct Cut {
  double bound = 0.0;
  double sensitivity = 0.0;  ///< share of the experts' values that pass
  double specificity = 0.0;  ///< share of the novices' values that do not
  double youden = 0.0;       ///< sensitivity + specificity − 1
  double area =
      0.0;  ///< under the ROC curve: chance that an expert's value is the better one, ties ½
};

/// The cut between neighbouring values, half-way, with the greatest Youden index; of equals the
/// strictest. Errors: bad_input for an empty group, or when all values are the same.
core::Result<Cut> youden_cut(const Vector& experts, const Vector& novices, Passing passing);

}  // namespace tractus::statistics
