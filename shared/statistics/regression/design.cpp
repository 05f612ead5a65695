#include "statistics/regression/design.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "core/try.hpp"

namespace tractus {
namespace statistics {
namespace {

using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double kLargest = 1e141;

/// Columns scaled to length one; with an intercept, centred first (the ones column stays out).
Extended normalised(const Design& design) {
  const Eigen::Index first = design.intercept ? 1 : 0;
  Extended z = design.columns.rightCols(design.columns.cols() - first).cast<long double>();
  for (Eigen::Index j = 0; j < z.cols(); ++j) {
    const long double size = z.col(j).cwiseAbs().maxCoeff();
    if (design.intercept) {
      const long double shift = z(0, j);
      z.col(j).array() -= shift;
      z.col(j).array() -= z.col(j).mean();
    }
    const long double length = z.col(j).norm();
    // What is left of a constant after centring is rounding alone.
    z.col(j) /= length > 1e-15L * size ? length : std::numeric_limits<long double>::infinity();
  }
  return z;
}

}  // namespace

Design with_intercept(const Matrix& columns, std::vector<std::string> names) {
  Design out;
  out.columns.resize(columns.rows(), columns.cols() + 1);
  out.columns.col(0).setOnes();
  out.columns.rightCols(columns.cols()) = columns;
  names.insert(names.begin(), "(Intercept)");
  out.names = std::move(names);
  return out;
}

core::Result<void> check_shape(const Design& design, const Vector& response) {
  const auto rows = design.columns.rows(), columns = design.columns.cols();
  core::require(rows == response.size(), "a design has one row per response");
  core::require(static_cast<std::size_t>(columns) == design.names.size(),
                "a design names every column");
  if (rows <= columns)
    return core::bad_input(
        fmt::format("{} row{} cannot determine {} coefficients and an error: at least {} "
                    "are needed",
                    rows, rows == 1 ? "" : "s", columns, columns + 1));
  return {};
}

core::Result<void> check_range(const Vector& values, const std::string& what) {
  const double most = values.cwiseAbs().maxCoeff(), spread = values.maxCoeff() - values.minCoeff();
  const bool large = !(most <= kLargest);
  if (!large && !(spread > 0.0 && spread < 1.0 / kLargest)) return {};
  return core::Error{core::Errc::out_of_range,
                     fmt::format("{} {} {:.3g}: the numbers are too {} for sums of squares, so "
                                 "rescale them",
                                 what, large ? "reaches" : "differs by", large ? most : spread,
                                 large ? "large" : "small")};
}

core::Result<void> check(const Design& design, const Vector& response) {
  TRY(check_shape(design, response));
  const auto rows = design.columns.rows(), columns = design.columns.cols();
  const bool fine = response.allFinite() && design.columns.allFinite();
  for (Eigen::Index i = 0; i < rows && !fine; ++i) {
    if (!std::isfinite(response[i]))
      return core::bad_input(fmt::format("the response in row {} is not a finite number", i + 1));
    for (Eigen::Index j = 0; j < columns; ++j)
      if (!std::isfinite(design.columns(i, j)))
        return core::bad_input(fmt::format("column '{}', row {}: not a finite number",
                                           design.names[static_cast<std::size_t>(j)], i + 1));
  }
  if (response.maxCoeff() == response.minCoeff())
    return core::bad_input(
        fmt::format("the response is {} in every row: there is nothing to explain", response[0]));
  for (Eigen::Index j = 0; j < columns; ++j)
    TRY(check_range(design.columns.col(j),
                    "column '" + design.names[static_cast<std::size_t>(j)] + "'"));
  return check_range(response, "the response");
}

std::string collinear_columns(const Design& design) {
  const Eigen::Index first = design.intercept ? 1 : 0;
  const Extended z = normalised(design);
  if (z.cols() == 0) return "";
  const auto name = [&](Eigen::Index j) {
    return design.names[static_cast<std::size_t>(j + first)];
  };
  std::string out;
  Eigen::ColPivHouseholderQR<Extended> qr;
  qr.setThreshold(1e-13L);
  qr.compute(z);
  const Eigen::Index rank = qr.rank();
  const Extended r = qr.matrixR().topLeftCorner(rank, z.cols());
  for (Eigen::Index k = rank; k < z.cols(); ++k) {
    const Eigen::Index column = qr.colsPermutation().indices()[k];
    std::vector<std::string> others;
    if (!z.col(column).isZero(0.0L)) {
      const Extended weights =
          r.leftCols(rank).triangularView<Eigen::Upper>().solve(r.col(k)).eval();
      for (Eigen::Index i = 0; i < rank; ++i)
        if (std::abs(weights(i, 0)) > 1e-9L)
          others.push_back(name(qr.colsPermutation().indices()[i]));
    }
    out += fmt::format(
        "{}'{}' is {}", out.empty() ? "" : "; ", name(column),
        others.empty() ? "constant"
                       : "a linear combination of " + fmt::format("{}", fmt::join(others, ", ")));
  }
  return out;
}

core::Error collinear_error(const Design& design) {
  if (const std::string named = collinear_columns(design); !named.empty())
    return core::bad_input("the columns are collinear: " + named);
  return {
      core::Errc::out_of_range,
      "the columns are too large, too small or too close to collinear for a double: rescale them"};
}

}  // namespace statistics
}  // namespace tractus
