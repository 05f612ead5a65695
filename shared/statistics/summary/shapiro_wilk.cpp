#include "statistics/summary/shapiro_wilk.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

double polynomial(std::span<const double> c, double x) {
  double out = 0.0;
  for (auto i = c.size(); i-- > 0;) out = out * x + c[i];
  return out;
}

constexpr std::array kLast = {0.0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056};
constexpr std::array kSecondLast = {0.0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633};

/// The weights a_1 … a_n, antisymmetric: those of the upper half are positive.
Vector weights(Eigen::Index n) {
  Vector m(n), a(n);
  for (Eigen::Index i = 0; i < n; ++i)
    m[i] = normal_quantile((static_cast<double>(i) + 0.625) / (static_cast<double>(n) + 0.25));
  if (n == 3) {
    a << -std::sqrt(0.5), 0.0, std::sqrt(0.5);
    return a;
  }
  const double squares = m.squaredNorm(), root = 1.0 / std::sqrt(static_cast<double>(n));
  const double last = polynomial(kLast, root) + m[n - 1] / std::sqrt(squares);
  double scale = (squares - 2.0 * m[n - 1] * m[n - 1]) / (1.0 - 2.0 * last * last);
  if (n > 5) {
    const double second = polynomial(kSecondLast, root) + m[n - 2] / std::sqrt(squares);
    scale = (squares - 2.0 * m[n - 1] * m[n - 1] - 2.0 * m[n - 2] * m[n - 2]) /
            (1.0 - 2.0 * last * last - 2.0 * second * second);
    a = m / std::sqrt(scale);
    a[n - 2] = second;
    a[1] = -second;
  } else {
    a = m / std::sqrt(scale);
  }
  a[n - 1] = last;
  a[0] = -last;
  return a;
}

/// From ln(1 − W) by Royston's normalising transformations.
double p_value(double w, double one_minus_w, double n) {
  if (n == 3.0)
    return std::max(0.0, 6.0 / M_PI * (std::asin(std::sqrt(w)) - std::asin(std::sqrt(0.75))));
  double y = std::log(one_minus_w), mean = 0.0, log_deviation = 0.0;
  if (n <= 11.0) {
    const double gamma = -2.273 + 0.459 * n;
    if (y >= gamma) return 0.0;
    y = -std::log(gamma - y);
    mean = polynomial(std::array{0.544, -0.39978, 0.025054, -6.714e-4}, n);
    log_deviation = polynomial(std::array{1.3822, -0.77857, 0.062767, -0.0020322}, n);
  } else {
    mean = polynomial(std::array{-1.5861, -0.31082, -0.083751, 0.0038915}, std::log(n));
    log_deviation = polynomial(std::array{-0.4803, -0.082676, 0.0030302}, std::log(n));
  }
  return normal_upper((y - mean) / std::exp(log_deviation));
}

}  // namespace

core::Result<ShapiroWilk> shapiro_wilk(const Vector& values) {
  const auto wrong = [](const char* what) { return core::Error{core::Errc::bad_input, what}; };
  if (values.size() < 3 || values.size() > 5000)
    return wrong("Shapiro-Wilk takes 3 to 5000 values");
  if (!values.allFinite()) return wrong("a value is not a finite number");
  Vector x = values;
  std::ranges::sort(x);
  const double range = x[x.size() - 1] - x[0];
  if (!(range > 0.0)) return wrong("the values are all equal");
  x = (x.array() - x[0]) / range;
  x.array() -= x.mean();
  const Vector a = weights(x.size());
  // 1 − W as a product, so that it keeps its digits where W is near 1.
  const double size = std::sqrt(a.squaredNorm() * x.squaredNorm()), aligned = a.dot(x);
  const double one_minus_w = (size - aligned) * (size + aligned) / (size * size);
  ShapiroWilk out;
  out.w = 1.0 - one_minus_w;
  out.p = p_value(out.w, one_minus_w, static_cast<double>(x.size()));
  return out;
}

}  // namespace statistics
}  // namespace tractus
