/// Learning curves: how fast a score falls over trials, and to what level.
///
///     power:        y = a n^−b        power with plateau:  y = a n^−b + c
///     exponential:  y = a e^−b(n − 1) + c
///
/// Least squares on y itself (not on its logarithm). For each b the rest is linear, so b is first
/// searched from 1e-4 to 20, then all are polished together by Gauss–Newton. Standard errors from
/// the Jacobian at the optimum. Compare shapes by AICc.
#pragma once

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

enum class CurveShape { power, power_plateau, exponential_plateau };

struct LearningCurve {
  std::vector<std::string> names;  ///< "a", "b" and, with a plateau, "c"
  Vector coefficients, standard_errors, t, p;
  double rss = 0.0, sigma = 0.0, df = 0.0;
  double log_likelihood = 0.0, aic = 0.0, aicc = 0.0, bic = 0.0;
};

/// @param trial  1, 2, … (> 0);  @param score  one per trial, finite; at least two more trials than
///   coefficients, so that AICc exists.
/// Errors: bad_input for fewer, or a constant score; out_of_range where the best b runs off the
/// search range: the data show no curve of this shape.
core::Result<LearningCurve> learning_curve(const Vector& trial, const Vector& score,
                                           CurveShape shape);

/// Share of the score left after the number of trials doubles, 2^−b of a power curve.
double share_per_doubling(const LearningCurve& power);

}  // namespace tractus::statistics
