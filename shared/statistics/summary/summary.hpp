/// A sample in three numbers.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Summary {
  double mean = 0.0;
  double deviation = 0.0;  ///< with n − 1; NaN for one value
  double autocorrelation = 0.0;  ///< lag 1: Σ (x_i − m)(x_i+1 − m) / Σ (x_i − m)²; NaN if constant
};

/// At least one finite value. Taken about the first value in 80-bit arithmetic.
Summary summary(const Vector& values);

}  // namespace tractus::statistics
