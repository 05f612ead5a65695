/// Exact tests by counting arrangements: no distribution assumed, for the few subjects there are.
#pragma once

#include <cstdint>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct PermutationSlope {
  std::uint64_t arrangements = 0;  ///< distinct ones of y; each as likely as the others
  std::uint64_t as_extreme = 0;    ///< with |slope| at least that observed
  std::uint64_t as_high = 0, as_low = 0;
  double p = 0.0, p_greater = 0.0, p_less = 0.0;
};

/// Is the slope of y on x 0? Counts over all distinct arrangements of y, which is best given as the
/// one with more ties. Compares n Σxy with a margin of 1e-12 of its size, so ties count.
/// Errors: bad_input for fewer than two values or no spread; too_large over `most` arrangements.
core::Result<PermutationSlope> permutation_slope(const Vector& x, const Vector& y,
                                                 double most = 5e7);

struct SignFlip {
  std::uint64_t flips = 0, as_extreme = 0;  ///< of 2ⁿ
  double p = 0.0;
};

/// Is the mean of paired differences 0? Over all 2ⁿ signs, n ≤ 28. Errors: bad_input, too_large.
core::Result<SignFlip> sign_flip(const Vector& differences);

}  // namespace tractus::statistics
