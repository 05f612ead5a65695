#include "statistics/anova/hotelling.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

Vector mean_of(const Matrix& values) {
  const Eigen::RowVectorXd first = values.row(0);
  return (first + (values.rowwise() - first).colwise().mean()).transpose();
}

/// dᵀ S⁻¹ d with S = Rᵀ R / df, R of the rows less their means.
core::Result<double> distance_squared(const Matrix& centred, double df, const Vector& difference,
                                      const std::vector<std::string>& names) {
  if (const auto named = collinear_columns({centred, names, false}); !named.empty())
    return core::bad_input("within groups " + named);
  const Vector scale = (centred.colwise().norm() / std::sqrt(df)).transpose();
  const Matrix z = centred * scale.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<Matrix> qr(z);
  const Vector turned = qr.colsPermutation().transpose() * difference.cwiseQuotient(scale);
  const auto p = z.cols();
  const Vector solved =
      qr.matrixR().topLeftCorner(p, p).triangularView<Eigen::Upper>().transpose().solve(turned);
  const double out = df * solved.squaredNorm();
  if (!std::isfinite(out))
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large or too small for sums of squares: rescale them"};
  return out;
}

core::Result<void> check_rows(const Matrix& values, Eigen::Index least) {
  if (!values.allFinite()) return core::bad_input("a response is not a finite number");
  for (Eigen::Index j = 0; j < values.cols(); ++j) TRY(check_range(values.col(j), "a response"));
  if (values.rows() >= least) return {};
  return core::bad_input(fmt::format("{} rows of {} responses: at least {} are needed",
                                     values.rows(), values.cols(), least));
}

Hotelling tested(double t_squared, double distance, double rows_factor, double df1, double df2) {
  Hotelling out;
  out.t_squared = t_squared;
  out.mahalanobis = std::sqrt(distance);
  out.df1 = df1;
  out.df2 = df2;
  out.f = t_squared * df2 / (df1 * rows_factor);
  out.p = f_upper(out.f, df1, df2);
  return out;
}

}  // namespace

core::Result<Hotelling> hotelling(const Matrix& values, const std::vector<std::string>& names) {
  TRY(check_rows(values, values.cols() + 1));
  const Vector mean = mean_of(values);
  const double n = static_cast<double>(values.rows()), p = static_cast<double>(values.cols());
  const auto distance =
      TRY(distance_squared(values.rowwise() - mean.transpose(), n - 1.0, mean, names));
  Hotelling out = tested(n * distance, distance, n - 1.0, p, n - p);
  out.means = mean;
  return out;
}

core::Result<Hotelling> hotelling(const Matrix& first, const Matrix& second,
                                  const std::vector<std::string>& names) {
  core::require(first.cols() == second.cols(), "both groups have the same responses");
  if (first.rows() < 2 || second.rows() < 2) return core::bad_input("each group needs two rows");
  Matrix centred(first.rows() + second.rows(), first.cols());
  centred << first, second;
  TRY(check_rows(centred, first.cols() + 2));
  const Vector one = mean_of(first), two = mean_of(second);
  centred.topRows(first.rows()).rowwise() -= one.transpose();
  centred.bottomRows(second.rows()).rowwise() -= two.transpose();
  const double n1 = static_cast<double>(first.rows()), n2 = static_cast<double>(second.rows());
  const double p = static_cast<double>(first.cols()), n = n1 + n2;
  const auto distance = TRY(distance_squared(centred, n - 2.0, one - two, names));
  Hotelling out = tested(n1 * n2 / n * distance, distance, n - 2.0, p, n - p - 1.0);
  out.means = one - two;
  return out;
}

}  // namespace statistics
}  // namespace tractus
