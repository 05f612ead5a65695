#include "statistics/regression/wald.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus::statistics {

JointTest joint_test(const Vector& coefficients, const Matrix& covariance,
                     const std::vector<Eigen::Index>& columns, double df2) {
  core::require(!columns.empty(), "a joint test is of one coefficient or more");
  const Vector b = coefficients(columns);
  const Vector scale = covariance(columns, columns).diagonal().cwiseSqrt();
  const Matrix v = scale.cwiseInverse().asDiagonal() * covariance(columns, columns) *
                   scale.cwiseInverse().asDiagonal();
  const Vector z = b.cwiseQuotient(scale);
  JointTest out;
  out.df1 = static_cast<double>(columns.size());
  out.df2 = df2;
  const double chi = z.dot(v.ldlt().solve(z));
  out.statistic = df2 > 0.0 ? chi / out.df1 : chi;
  out.p = df2 > 0.0 ? f_upper(out.statistic, out.df1, df2) : chi_squared_upper(chi, out.df1);
  return out;
}

JointTest joint_test_by_contrasts(const Vector& coefficients, const Matrix& covariance,
                                  const std::vector<Eigen::Index>& columns,
                                  const std::function<double(const Vector&)>& df_of) {
  core::require(!columns.empty(), "a joint test is of one coefficient or more");
  const Vector b = coefficients(columns);
  // Directions are those of the covariance as it stands, so that a contrast's unit counts as in the
  // source.
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix(covariance(columns, columns)));
  const double q = static_cast<double>(columns.size());
  double squares = 0.0, expectation = 0.0, df = 0.0;
  for (Eigen::Index m = 0; m < b.size(); ++m) {
    const Vector direction = eigen.eigenvectors().col(m);
    squares += std::pow(direction.dot(b), 2) / eigen.eigenvalues()[m];
    Vector contrast = Vector::Zero(coefficients.size());
    contrast(columns) = direction;
    df = df_of(contrast);
    if (df > 2.0) expectation += df / (df - 2.0);
  }
  // Fewer directions than coefficients with an expectation: no more can be said than 2 df.
  if (columns.size() > 1) df = expectation > q ? 2.0 * expectation / (expectation - q) : 2.0;
  return {squares / q, q, df, f_upper(squares / q, q, df)};
}

}  // namespace tractus::statistics
