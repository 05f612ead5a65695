/// Shapiro–Wilk test of normality, Royston's AS R94 (1995).
///
///     W = (Σ a_i x_(i))² / Σ (x_i − x̄)²
///
/// For 3 to 5000 values. Not a gate: with ten subjects it sees only gross departures.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct ShapiroWilk {
  double w = 0.0, p = 0.0;
};

/// Errors: bad_input for fewer than 3 or more than 5000 values, not finite, or all equal.
core::Result<ShapiroWilk> shapiro_wilk(const Vector& values);

}  // namespace tractus::statistics
