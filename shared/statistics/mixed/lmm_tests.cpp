#include "statistics/mixed/lmm_tests.hpp"

namespace tractus {
namespace statistics {

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
  if (how == SmallSample::kenward_roger) return joint_test(kenward_roger(fit), columns);
  if (fit.tau_squared > 0.0)
    return joint_test_by_contrasts(
        fit.coefficients, fit.covariance, columns,
        [&](const Vector& contrast) { return satterthwaite_df(fit, contrast); });
  return joint_test(fit.coefficients, fit.covariance, columns, fit.df[columns[0]]);
}

KenwardRoger kenward_roger(const Lmm& fit) {
  const auto& bend = fit.curvature;
  return kenward_roger(fit.coefficients, fit.covariance,
                       {bend.covariance_slope[0], bend.covariance_slope[1]},
                       bend.expected_covariance, bend.bias);
}

}  // namespace statistics
}  // namespace tractus
