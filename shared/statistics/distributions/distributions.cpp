#include "statistics/distributions/distributions.hpp"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

namespace tractus {
namespace statistics {
namespace {

namespace bm = boost::math;
namespace pol = boost::math::policies;

/// Boost answers NaN or infinity instead of throwing.
using Quiet =
    pol::policy<pol::domain_error<pol::ignore_error>, pol::pole_error<pol::ignore_error>,
                pol::overflow_error<pol::ignore_error>, pol::underflow_error<pol::ignore_error>,
                pol::rounding_error<pol::ignore_error>, pol::evaluation_error<pol::ignore_error>>;

using Normal = bm::normal_distribution<double, Quiet>;
using StudentT = bm::students_t_distribution<double, Quiet>;
using FisherF = bm::fisher_f_distribution<double, Quiet>;
using ChiSquared = bm::chi_squared_distribution<double, Quiet>;
using Beta = bm::beta_distribution<double, Quiet>;
using Binomial = bm::binomial_distribution<double, Quiet>;
using NonCentralF = bm::non_central_f_distribution<double, Quiet>;
using NonCentralT = bm::non_central_t_distribution<double, Quiet>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// ∫ f over [low, high] in eight panels of 20 Gauss points: the integrands below are smooth bells,
/// and a fixed cost keeps a table of comparisons from taking minutes.
template <class F>
double integral(const F& f, double low, double high) {
  constexpr int kPanels = 8;
  const double step = (high - low) / kPanels;
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i)
    sum += bm::quadrature::gauss<double, 20>::integrate(f, low + i * step, low + (i + 1) * step);
  return sum;
}

/// P(range of k standard normals ≤ w) = k ∫ φ(z) [Φ(z) − Φ(z − w)]^(k−1) dz.
double normal_range_cdf(double w, double groups) {
  if (w <= 0.0) return 0.0;
  const auto density = [&](double z) {
    return normal_density(z) * std::pow(normal_cdf(z) - normal_cdf(z - w), groups - 1.0);
  };
  return std::min(1.0, groups * integral(density, -9.0, 9.0 + std::min(w, 9.0)));
}

}  // namespace

double student_t_two_sided(double t, double df) { return 2.0 * student_t_upper(std::abs(t), df); }
double student_t_upper(double t, double df) {
  if (!(df > 0.0) || std::isnan(t)) return kNaN;
  if (std::isinf(t)) return t > 0.0 ? 0.0 : 1.0;
  return bm::cdf(bm::complement(StudentT(df), t));
}
double student_t_quantile(double p, double df) {
  if (!(df > 0.0)) return kNaN;
  return bm::quantile(StudentT(df), p);
}
double f_upper(double f, double df1, double df2) {
  if (!(df1 > 0.0 && df2 > 0.0 && f >= 0.0)) return kNaN;
  if (std::isinf(f)) return 0.0;
  return bm::cdf(bm::complement(FisherF(df1, df2), f));
}
double f_quantile_upper(double q, double df1, double df2) {
  if (!(df1 > 0.0 && df2 > 0.0)) return kNaN;
  return bm::quantile(bm::complement(FisherF(df1, df2), q));
}
double chi_squared_upper(double x, double df) {
  if (!(df > 0.0 && x >= 0.0)) return kNaN;
  if (std::isinf(x)) return 0.0;
  return bm::cdf(bm::complement(ChiSquared(df), x));
}
double chi_squared_quantile_upper(double q, double df) {
  if (!(df > 0.0)) return kNaN;
  return bm::quantile(bm::complement(ChiSquared(df), q));
}
double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
double normal_upper(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }
double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI); }
double normal_quantile(double p) { return bm::quantile(Normal(), p); }
double beta_quantile(double p, double a, double b) {
  if (!(a > 0.0 && b > 0.0)) return kNaN;
  return bm::quantile(Beta(a, b), p);
}
double noncentral_f_upper(double f, double df1, double df2, double lambda) {
  if (!(df1 > 0.0 && df2 > 0.0 && lambda >= 0.0 && f >= 0.0)) return kNaN;
  return bm::cdf(bm::complement(NonCentralF(df1, df2, lambda), f));
}
double noncentral_t_cdf(double t, double df, double delta) {
  if (!(df > 0.0) || !std::isfinite(t) || !std::isfinite(delta)) return kNaN;
  return bm::cdf(NonCentralT(df, delta), t);
}
double noncentral_t_upper(double t, double df, double delta) {
  if (!(df > 0.0) || !std::isfinite(t) || !std::isfinite(delta)) return kNaN;
  return bm::cdf(bm::complement(NonCentralT(df, delta), t));
}
double binomial_upper(double x, double n, double p) {
  if (!(n >= 0.0 && p >= 0.0 && p <= 1.0)) return kNaN;
  if (x <= 0.0) return 1.0;
  if (x > n) return 0.0;
  return bm::cdf(bm::complement(Binomial(n, p), x - 1.0));
}

double studentized_range_upper(double q, double groups, double df) {
  if (!(groups >= 2.0 && df > 0.0) || std::isnan(q)) return kNaN;
  if (q <= 0.0) return 1.0;
  // s² df ~ χ²(df): the density of s, with its logarithm to avoid overflow at large df.
  const double log_scale =
      0.5 * df * std::log(df) - std::lgamma(0.5 * df) - (0.5 * df - 1.0) * std::log(2.0);
  const auto part = [&](double s) {
    const double log_density = log_scale + (df - 1.0) * std::log(s) - 0.5 * df * s * s;
    return std::exp(log_density) * (1.0 - normal_range_cdf(q * s, groups));
  };
  const double spread = 9.0 / std::sqrt(2.0 * df);
  const double low = std::max(1e-12, 1.0 - spread),
               high = 1.0 + std::max(spread, 3.0 * spread / df);
  return std::max(0.0, integral(part, low, high));
}

}  // namespace statistics
}  // namespace tractus
