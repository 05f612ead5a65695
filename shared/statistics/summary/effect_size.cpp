#include "statistics/summary/effect_size.hpp"

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

double variance(const Vector& x) {
  return (x.array() - x.mean()).square().sum() / static_cast<double>(x.size() - 1);
}

core::Result<void> check(const Vector& x, const Vector& y) {
  if (x.size() < 2 || y.size() < 2)
    return core::Error{core::Errc::bad_input, "a sample of fewer than two values has no spread"};
  if (!x.allFinite() || !y.allFinite())
    return core::Error{core::Errc::bad_input, "a value is not a finite number"};
  Vector both(x.size() + y.size());
  both << x, y;
  TRY(check_range(both, "the response"));
  return {};
}

core::Error no_spread() {
  return {core::Errc::bad_input, "the values do not vary: their difference cannot be judged"};
}

/// δ with P(T ≥ t | δ) = upper: the probability rises with δ, so bisection is safe.
double noncentrality(double t, double df, double upper) {
  double low = t - 10.0 - std::abs(t), high = t + 10.0 + std::abs(t);
  for (int i = 0; i < 200 && high - low > 1e-15 * (1.0 + std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (noncentral_t_upper(t, df, middle) < upper ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// What follows from a difference, its standard error and the scale from t to d.
MeanDifference finished(double difference, double se, double df, double t_to_d) {
  MeanDifference out;
  out.difference = difference;
  out.df = df;
  out.t = difference / se;
  out.p = student_t_two_sided(out.t, df);
  const double reach = student_t_quantile(0.975, df) * se;
  out.difference_95 = {difference - reach, difference + reach};
  out.d = out.t * t_to_d;
  out.g = hedges_j(df) * out.d;
  out.d_95 = {noncentrality(out.t, df, 0.025) * t_to_d, noncentrality(out.t, df, 0.975) * t_to_d};
  return out;
}

}  // namespace

double hedges_j(double df) {
  return std::exp(std::lgamma(0.5 * df) - std::lgamma(0.5 * (df - 1.0))) / std::sqrt(0.5 * df);
}

core::Result<MeanDifference> two_samples(const Vector& x, const Vector& y) {
  TRY(check(x, y));
  const double n = static_cast<double>(x.size()), m = static_cast<double>(y.size());
  const double df = n + m - 2.0;
  const double pooled = ((n - 1.0) * variance(x) + (m - 1.0) * variance(y)) / df;
  if (!(pooled > 0.0)) return no_spread();
  const double scale = std::sqrt(1.0 / n + 1.0 / m);
  auto out = finished(x.mean() - y.mean(), std::sqrt(pooled) * scale, df, scale);
  out.d_other = out.difference / std::sqrt(variance(y));
  return out;
}

core::Result<MeanDifference> paired(const Vector& x, const Vector& y) {
  core::require(x.size() == y.size(), "paired values come in pairs");
  TRY(check(x, y));
  const Vector each = x - y;
  const double n = static_cast<double>(each.size()), spread = variance(each);
  if (!(spread > 0.0)) return no_spread();
  auto out = finished(each.mean(), std::sqrt(spread / n), n - 1.0, 1.0 / std::sqrt(n));
  out.d_other = out.difference / std::sqrt(0.5 * (variance(x) + variance(y)));
  return out;
}

core::Result<WelchT> welch_t(const Vector& x, const Vector& y) {
  TRY(check(x, y));
  const double a = variance(x) / static_cast<double>(x.size());
  const double b = variance(y) / static_cast<double>(y.size());
  if (!(a + b > 0.0)) return no_spread();
  const double difference = x.mean() - y.mean();
  WelchT out;
  out.t = difference / std::sqrt(a + b);
  out.df = (a + b) * (a + b) /
           (a * a / static_cast<double>(x.size() - 1) + b * b / static_cast<double>(y.size() - 1));
  out.p = student_t_two_sided(out.t, out.df);
  const double reach = student_t_quantile(0.975, out.df) * std::sqrt(a + b);
  out.difference_95 = {difference - reach, difference + reach};
  return out;
}

core::Result<Pearson> pearson(const Vector& x, const Vector& y) {
  core::require(x.size() == y.size(), "a correlation is of pairs");
  const auto wrong = [](const char* what) { return core::Error{core::Errc::bad_input, what}; };
  if (x.size() < 3 || !x.allFinite() || !y.allFinite())
    return wrong("a correlation needs three pairs of finite numbers");
  const auto about_mean = [](const Vector& v) {
    const Vector shifted = (v.array() - v[0]).matrix();
    const Vector centred = (shifted.array() - shifted.mean()).matrix();
    const double size = centred.cwiseAbs().maxCoeff();
    return size > 0.0 ? Vector(centred / size) : centred;
  };
  const Vector a = about_mean(x), b = about_mean(y);
  const double spread = a.norm() * b.norm();
  if (!(spread > 0.0)) return wrong("x or y is the same everywhere: no correlation");
  const double n = static_cast<double>(x.size());
  Pearson out;
  out.r = std::clamp(a.dot(b) / spread, -1.0, 1.0);
  out.df = n - 2.0;
  out.t = out.r * std::sqrt(out.df / ((1.0 - out.r) * (1.0 + out.r)));
  out.p = student_t_two_sided(out.t, out.df);
  const double reach = n > 3.0 ? normal_quantile(0.975) / std::sqrt(n - 3.0) : std::nan("");
  out.r_95 = {std::tanh(std::atanh(out.r) - reach), std::tanh(std::atanh(out.r) + reach)};
  return out;
}

}  // namespace statistics
}  // namespace tractus
