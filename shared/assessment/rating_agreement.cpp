#include "assessment/rating_agreement.hpp"

#include "statistics/agreement/confusion.hpp"
#include "statistics/agreement/icc.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/summary/summary.hpp"

namespace tractus {
namespace assessment {
namespace {

using statistics::Matrix;

std::optional<double> kappa_of(const Matrix& scores, const ScoreScale& scale) {
  const Eigen::Index points = scale.high - scale.low + 1;
  Matrix counts = Matrix::Zero(points, points);
  for (Eigen::Index trial = 0; trial < scores.rows(); ++trial)
    counts(Eigen::Index(scores(trial, 0)) - scale.low,
           Eigen::Index(scores(trial, 1)) - scale.low) += 1.0;
  const auto found = statistics::confusion(counts);
  return found ? std::optional(found->kappa_quadratic) : std::nullopt;
}

}  // namespace

RatingAgreement rating_agreement(const Matrix& scores, const std::optional<ScoreScale>& scale) {
  RatingAgreement out;
  if (scores.rows() < 2) {
    out.note = "two trials or more that the same raters have rated are needed";
    return out;
  }
  if (scale && scores.cols() == 2) out.kappa = kappa_of(scores, *scale);
  const auto found = statistics::icc(scores);
  if (!found) {
    out.note = "the raters differ by the same on every trial: there is no error to estimate";
    return out;
  }
  out.single = found->icc2, out.single_95 = found->icc2_95;
  out.mean = found->icc2k, out.mean_95 = found->icc2k_95;
  return out;
}

std::optional<DifferenceLimits> difference_limits(const Matrix& scores) {
  if (scores.cols() != 2 || scores.rows() < 2) return std::nullopt;
  const statistics::Vector differences = scores.col(0) - scores.col(1);
  const auto found = statistics::summary(differences);
  const double reach = statistics::normal_quantile(0.975) * found.deviation;
  return DifferenceLimits{found.mean, found.mean - reach, found.mean + reach};
}

}  // namespace assessment
}  // namespace tractus
