/// What a regression takes: a design and a response, checked once for all of them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::statistics {

using Matrix = Eigen::MatrixXd;  // [row][column]
using Vector = Eigen::VectorXd;

/// The columns of a linear predictor. With `intercept` the first column is all ones.
struct Design {
  Matrix columns;                  ///< [observation][column]
  std::vector<std::string> names;  ///< one per column
  bool intercept = true;
};

/// A design of these columns, with a column of ones put in front.
Design with_intercept(const Matrix& columns, std::vector<std::string> names);

/// Every number finite, more rows than columns, the response not constant. Errors: bad_input naming
/// the column and the row (1-based), or saying how many rows are needed.
core::Result<void> check(const Design& design, const Vector& response);
/// Squares of these numbers stay within a double. Errors: out_of_range naming `what` where one is
/// beyond ±1e141, or they differ by less than 1e-141.
core::Result<void> check_range(const Vector& values, const std::string& what);
/// Of check(), more rows than columns alone.
core::Result<void> check_shape(const Design& design, const Vector& response);

/// Names the columns that others already determine, with those others: "x3 is a linear combination
/// of x1, x2". Nothing wrong: empty.
std::string collinear_columns(const Design& design);
/// That, as an Error bad_input; out_of_range where none can be named.
core::Error collinear_error(const Design& design);

}  // namespace tractus::statistics
