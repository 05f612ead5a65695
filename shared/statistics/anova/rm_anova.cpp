#include "statistics/anova/rm_anova.hpp"

#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

using ExtendedArray = Eigen::Array<long double, Eigen::Dynamic, Eigen::Dynamic>;

core::Result<void> check(const Matrix& values) {
  if (values.rows() < 2 || values.cols() < 2)
    return core::bad_input("repeated measures need at least two subjects and two levels");
  if (!values.allFinite()) return core::bad_input("a value is missing or not a finite number");
  TRY(check_range(values.reshaped(), "the response"));
  return {};
}

void add_corrections(const Matrix& values, RmAnova& out) {
  const double n = static_cast<double>(values.rows()), d = static_cast<double>(values.cols() - 1);
  const Matrix centred = values.rowwise() - values.colwise().mean();
  const Matrix covariance = centred.transpose() * centred / (n - 1.0);
  const Matrix rows = covariance.rowwise() - covariance.colwise().mean();
  const Matrix c = rows.colwise() - rows.rowwise().mean();
  out.epsilon_gg = c.trace() * c.trace() / (d * c.squaredNorm());
  out.epsilon_hf = (n * d * out.epsilon_gg - 2.0) / (d * (n - 1.0 - d * out.epsilon_gg));
  out.epsilon_lower = 1.0 / d;
  const auto corrected = [&](double epsilon) {
    return f_upper(out.f, out.df1 * epsilon, out.df2 * epsilon);
  };
  out.p_gg = corrected(std::min(1.0, out.epsilon_gg));
  // With few subjects the estimate can pass through infinity: it then means "above 1".
  const bool above = !(out.epsilon_hf >= out.epsilon_lower && out.epsilon_hf <= 1.0);
  out.p_hf = corrected(above ? 1.0 : out.epsilon_hf);
  out.p_lower = corrected(out.epsilon_lower);
  const Matrix m = contrasts(values.cols());
  out.mauchly = mauchly(m.transpose() * covariance * m, n - 1.0);
}

}  // namespace

core::Result<RmAnova> rm_anova(const Matrix& values) {
  TRY(check(values));
  const auto n = static_cast<long double>(values.rows()),
             k = static_cast<long double>(values.cols());
  const long double shift = values(0, 0);
  ExtendedArray y = values.cast<long double>().array() - shift;
  const long double mean = y.mean();
  y -= mean;
  const Eigen::Array<long double, Eigen::Dynamic, 1> subjects = y.rowwise().mean();
  const Eigen::Array<long double, 1, Eigen::Dynamic> levels = y.colwise().mean();
  const ExtendedArray error = (y.colwise() - subjects).rowwise() - (levels - y.mean());
  RmAnova out;
  out.level_means = (levels + (mean + shift)).cast<double>().transpose();
  const long double effect = n * (levels - levels.mean()).square().sum();
  const long double rest = error.square().sum();
  out.ss_effect = static_cast<double>(effect);
  out.ss_subjects = static_cast<double>(k * (subjects - subjects.mean()).square().sum());
  out.ss_error = static_cast<double>(rest);
  if (!(out.ss_error > 1e-28 * (out.ss_effect + out.ss_subjects)))
    return core::bad_input(
        "subjects differ by constants alone: there is no error to judge the levels by");
  if (!std::isfinite(out.ss_error) || !std::isfinite(out.ss_effect + out.ss_subjects))
    return core::Error{core::Errc::out_of_range,
                       "the numbers are too large for sums of squares: rescale them"};
  out.df1 = static_cast<double>(k - 1.0L);
  out.df2 = static_cast<double>((k - 1.0L) * (n - 1.0L));
  out.f = static_cast<double>((effect / (k - 1.0L)) / (rest / ((k - 1.0L) * (n - 1.0L))));
  out.p = f_upper(out.f, out.df1, out.df2);
  out.partial_eta_squared = out.ss_effect / (out.ss_effect + out.ss_error);
  out.generalized_eta_squared = out.ss_effect / (out.ss_effect + out.ss_subjects + out.ss_error);
  const double excess = out.df1 * (out.f - 1.0);
  out.partial_omega_squared = excess / (excess + static_cast<double>(n * k));
  add_corrections(values, out);
  return out;
}

Contrast contrast(const Matrix& values, const Vector& weights) {
  core::require(values.cols() == weights.size() && values.rows() > 1,
                "a contrast has one weight per level and more than one subject");
  const Vector each = values * weights;
  const double n = static_cast<double>(each.size());
  Contrast out;
  out.estimate = each.mean();
  out.df = n - 1.0;
  out.standard_error = std::sqrt((each.array() - out.estimate).square().sum() / (n - 1.0) / n);
  out.t = out.estimate / out.standard_error;
  out.p = student_t_two_sided(out.t, out.df);
  const double reach = student_t_quantile(0.975, out.df) * out.standard_error;
  out.ci_low = out.estimate - reach;
  out.ci_high = out.estimate + reach;
  return out;
}

Contrast linear_trend(const Matrix& values) {
  const double half = 0.5 * static_cast<double>(values.cols() - 1);
  return contrast(values, Vector::LinSpaced(values.cols(), -half, half));
}

}  // namespace statistics
}  // namespace tractus
