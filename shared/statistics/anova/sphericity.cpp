#include "statistics/anova/sphericity.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {

Matrix contrasts(Eigen::Index k) {
  Matrix out = Matrix::Zero(k, k - 1);
  for (Eigen::Index j = 1; j < k; ++j) {
    const double before = static_cast<double>(j), length = std::sqrt(before * (before + 1.0));
    for (Eigen::Index i = 0; i < j; ++i) out(i, j - 1) = 1.0 / length;
    out(j, j - 1) = -before / length;
  }
  return out;
}

Mauchly mauchly(const Matrix& error, double nu) {
  const double q = static_cast<double>(error.rows());
  Mauchly out;
  out.df = q * (q + 1.0) / 2.0 - 1.0;
  out.w = out.chi_squared = out.p = std::numeric_limits<double>::quiet_NaN();
  if (q < 2.0 || nu < q) return out;
  out.w = error.determinant() / std::pow(error.trace() / q, q);
  const double rho = 1.0 - (2.0 * q * q + q + 2.0) / (6.0 * q * nu);
  out.chi_squared = -nu * rho * std::log(out.w);
  const double w2 = (q + 2.0) * (q - 1.0) * (q - 2.0) *
                    (2.0 * q * q * q + 6.0 * q * q + 3.0 * q + 2.0) /
                    (288.0 * std::pow(nu * q * rho, 2.0));
  const double first = chi_squared_upper(out.chi_squared, out.df);
  out.p = first + w2 * (chi_squared_upper(out.chi_squared, out.df + 4.0) - first);
  return out;
}

}  // namespace statistics
}  // namespace tractus
