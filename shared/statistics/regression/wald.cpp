#include "statistics/regression/wald.hpp"

#include <Eigen/Cholesky>

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

}  // namespace tractus::statistics
