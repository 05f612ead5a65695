#include "statistics/mixed/lmm_tests.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

Matrix adjusted_covariance(const Lmm& fit) {
  return fit.covariance + 2.0 * fit.covariance * fit.curvature.bias * fit.covariance;
}

/// λ and m of the scaled F, from A_1 and A_2 (Kenward & Roger 1997, section 2.3).
struct Scaling {
  double scale = 1.0, df = 0.0;
};

Scaling scaling(double a1, double a2, double q) {
  const double b = (a1 + 6.0 * a2) / (2.0 * q);
  const double g = ((q + 1.0) * a1 - (q + 4.0) * a2) / ((q + 2.0) * a2);
  const double below = 3.0 * q + 2.0 * (1.0 - g);
  const double c1 = g / below, c2 = (q - g) / below, c3 = (q + 2.0 - g) / below;
  const double mean = 1.0 / (1.0 - a2 / q);
  const double variance = 2.0 / q * (1.0 + c1 * b) / (std::pow(1.0 - c2 * b, 2) * (1.0 - c3 * b));
  const double rho = variance / (2.0 * mean * mean);
  const double m = 4.0 + (q + 2.0) / (q * rho - 1.0);
  return {m / (mean * (m - 2.0)), m};
}

JointTest kenward_roger_of(const Lmm& fit, const Matrix& adjusted,
                           const std::vector<Eigen::Index>& columns) {
  const auto& bend = fit.curvature;
  const auto p = fit.coefficients.size();
  const double q = static_cast<double>(columns.size());
  Matrix theta = Matrix::Zero(p, p);
  const auto size = std::ssize(columns);
  const Matrix inverse =
      Matrix(fit.covariance(columns, columns)).ldlt().solve(Matrix::Identity(size, size));
  theta(columns, columns) = inverse;
  std::array<Matrix, 2> turned;  // Θ Φ D_a Φ
  for (std::size_t a = 0; a < 2; ++a) turned[a] = theta * bend.covariance_slope[a];
  double a1 = 0.0, a2 = 0.0;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const double w =
          bend.expected_covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      a1 += w * turned[a].trace() * turned[b].trace();
      a2 += w * (turned[a] * turned[b]).trace();
    }
  const Scaling scaled = scaling(a1, a2, q);
  const Vector b = fit.coefficients(columns);
  JointTest out{0.0, q, scaled.df, 0.0};
  out.statistic = scaled.scale / q * b.dot(Matrix(adjusted(columns, columns)).ldlt().solve(b));
  out.p = f_upper(out.statistic, out.df1, out.df2);
  return out;
}

}  // namespace

double satterthwaite_df(const Lmm& fit, const Vector& contrast) {
  if (fit.tau_squared == 0.0) return fit.df[0];
  const double variance = contrast.dot(fit.covariance * contrast);
  Eigen::Vector2d gradient;
  for (std::size_t a = 0; a < 2; ++a)
    gradient[static_cast<Eigen::Index>(a)] =
        contrast.dot(fit.curvature.covariance_slope[a] * contrast);
  return 2.0 * variance * variance / gradient.dot(fit.curvature.variance_covariance * gradient);
}

JointTest joint_test(const Lmm& fit, const std::vector<Eigen::Index>& columns, SmallSample how) {
  core::require(!columns.empty(), "a joint test is of one coefficient or more");
  if (how == SmallSample::kenward_roger)
    return kenward_roger_of(fit, adjusted_covariance(fit), columns);
  if (fit.tau_squared > 0.0)
    return joint_test_by_contrasts(
        fit.coefficients, fit.covariance, columns,
        [&](const Vector& contrast) { return satterthwaite_df(fit, contrast); });
  return joint_test(fit.coefficients, fit.covariance, columns, fit.df[columns[0]]);
}

KenwardRoger kenward_roger(const Lmm& fit) {
  KenwardRoger out;
  out.covariance = adjusted_covariance(fit);
  out.standard_errors = out.covariance.diagonal().cwiseSqrt();
  out.t = fit.coefficients.cwiseQuotient(out.standard_errors);
  out.df.resize(out.t.size());
  out.p.resize(out.t.size());
  for (Eigen::Index j = 0; j < out.t.size(); ++j) {
    out.df[j] = kenward_roger_of(fit, out.covariance, {j}).df2;
    out.p[j] = student_t_two_sided(out.t[j], out.df[j]);
  }
  return out;
}

}  // namespace statistics
}  // namespace tractus
