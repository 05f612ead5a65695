/// Several coefficients at once: are they all 0?
///
///     F = bᵀ V⁻¹ b / q on q and df2 degrees of freedom; without df2, q F is χ² on q
#pragma once

#include <functional>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct JointTest {
  double statistic = 0.0, df1 = 0.0, df2 = 0.0, p = 0.0;  ///< df2 = 0: a χ²
};

/// @param columns  which coefficients, at least one; their covariance must be positive definite
///   (a fit that was not refused has such).
JointTest joint_test(const Vector& coefficients, const Matrix& covariance,
                     const std::vector<Eigen::Index>& columns, double df2);

/// The same where each contrast has degrees of freedom of its own: F is the mean of the squared t of
/// the covariance's principal directions, df2 makes the expectation of F that of their sum
/// (Fai & Cornelius 1996, as lmerTest does).
/// @param df_of  degrees of freedom of a contrast of all coefficients
JointTest joint_test_by_contrasts(const Vector& coefficients, const Matrix& covariance,
                                  const std::vector<Eigen::Index>& columns,
                                  const std::function<double(const Vector&)>& df_of);

}  // namespace tractus::statistics
