#include "statistics/agreement/signal_detection.hpp"

#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

double rate(const Proportion& of, RateCorrection correction) {
  if (correction == RateCorrection::log_linear) return (of.successes + 0.5) / (of.trials + 1.0);
  if (correction == RateCorrection::extremes && of.successes == 0.0) return 0.5 / of.trials;
  if (correction == RateCorrection::extremes && of.successes == of.trials)
    return 1.0 - 0.5 / of.trials;
  return of.share();
}

double grier(double h, double f) {
  if (h == f) return 0.5;
  if (h > f) return 0.5 + (h - f) * (1.0 + h - f) / (4.0 * h * (1.0 - f));
  return 0.5 - (f - h) * (1.0 + f - h) / (4.0 * f * (1.0 - h));
}

}  // namespace

core::Result<SignalDetection> signal_detection(const Proportion& hits,
                                               const Proportion& false_alarms,
                                               RateCorrection correction) {
  SignalDetection out;
  const double h = out.hit_rate = rate(hits, correction);
  const double f = out.false_alarm_rate = rate(false_alarms, correction);
  if (!(h > 0.0 && h < 1.0 && f > 0.0 && f < 1.0))
    return core::Error{core::Errc::bad_input,
                       "a hit or false-alarm rate of 0 or 1 has no d' without correction"};
  const double z_h = normal_quantile(h), z_f = normal_quantile(f);
  out.d_prime = z_h - z_f;
  out.criterion = -0.5 * (z_h + z_f);
  out.relative_criterion = out.criterion / out.d_prime;
  out.ln_beta = out.d_prime * out.criterion;
  out.beta = std::exp(out.ln_beta);
  out.a_prime = grier(h, f);
  out.auc = normal_cdf(out.d_prime / std::sqrt(2.0));
  const auto part = [](double p, double z, double n) {
    return p * (1.0 - p) / (n * normal_density(z) * normal_density(z));
  };
  out.variance = part(h, z_h, hits.trials) + part(f, z_f, false_alarms.trials);
  const double reach = normal_quantile(0.975) * std::sqrt(out.variance);
  out.d_prime_95 = {out.d_prime - reach, out.d_prime + reach};
  return out;
}

}  // namespace statistics
}  // namespace tractus
