#include "statistics/summary/power.hpp"

#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

constexpr double kMost = 1e6;

double power_of_t(double delta, double df, double alpha) {
  const double critical = student_t_quantile(1.0 - 0.5 * alpha, df);
  return noncentral_t_upper(critical, df, delta) + noncentral_t_cdf(-critical, df, delta);
}

double power_of_f(double lambda, double df1, double df2, double alpha) {
  return noncentral_f_upper(f_quantile_upper(alpha, df1, df2), df1, df2, lambda);
}

double power_of_z(double shift, double alpha) {
  const double critical = normal_quantile(1.0 - 0.5 * alpha);
  return normal_upper(critical - shift) + normal_cdf(-critical - shift);
}

}  // namespace

double power_two_samples(double d, double n, double alpha) {
  return power_of_t(d * std::sqrt(0.5 * n), 2.0 * n - 2.0, alpha);
}

double power_paired(double d, double n, double alpha) {
  return power_of_t(d * std::sqrt(n), n - 1.0, alpha);
}

double power_correlation(double r, double n, double alpha) {
  const double t = student_t_quantile(1.0 - 0.5 * alpha, n - 2.0);
  const double critical = std::atanh(t / std::sqrt(t * t + n - 2.0));
  const double z = std::atanh(r) + r / (2.0 * (n - 1.0)), scale = std::sqrt(n - 3.0);
  return normal_cdf((z - critical) * scale) + normal_cdf((-z - critical) * scale);
}

double power_one_way(double f, double groups, double n, double alpha) {
  return power_of_f(groups * n * f * f, groups - 1.0, groups * (n - 1.0), alpha);
}

double power_regression(double f2, double u, double v, double alpha) {
  return power_of_f(f2 * (u + v + 1.0), u, v, alpha);
}

double power_two_proportions(double h, double n, double alpha) {
  return power_of_z(std::abs(h) * std::sqrt(0.5 * n), alpha);
}

double power_one_proportion(double h, double n, double alpha) {
  return power_of_z(std::abs(h) * std::sqrt(n), alpha);
}

double power_repeated(const RepeatedDesign& design, double n, double alpha) {
  const double steps = (design.levels - 1.0) * design.epsilon;
  const double lambda =
      design.f * design.f * n * design.levels * design.epsilon / (1.0 - design.correlation);
  return power_of_f(lambda, steps, (n - 1.0) * steps, alpha);
}

core::Result<double> needed_size(const std::function<double(double n)>& power_of, double target,
                                 double low) {
  double high = low;
  while (!(power_of(high) >= target)) {
    if (high >= kMost)
      return core::Error{core::Errc::out_of_range,
                         "a million would not be enough: the effect is too small"};
    low = high;
    high = std::min(kMost, 2.0 * high);
  }
  for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (power_of(middle) < target ? low : high) = middle;
  }
  return high;
}

}  // namespace statistics
}  // namespace tractus
