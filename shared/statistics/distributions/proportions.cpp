#include "statistics/distributions/proportions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

double reach(double level) { return normal_quantile(0.5 + 0.5 * level); }

double log_choose(double n, double k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

}  // namespace

core::Result<Proportion> Proportion::make(double successes, double trials) {
  if (!(trials >= 1.0 && successes >= 0.0 && successes <= trials) ||
      std::floor(successes) != successes || std::floor(trials) != trials || std::isinf(trials))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{} of {} is not a count of successes", successes, trials)};
  return Proportion{successes, trials};
}

Interval wilson(const Proportion& of, double level, bool continuity) {
  const double z = reach(level), n = of.trials, x = of.successes, q = 1.0 - of.share();
  const double width = 2.0 * (n + z * z), centre = 2.0 * x + z * z;
  if (!continuity) {
    const double root = z * std::sqrt(z * z + 4.0 * x * q);
    return {x == 0.0 ? 0.0 : (centre - root) / width, x == n ? 1.0 : (centre + root) / width};
  }
  const double p = of.share();
  const double down = z * std::sqrt(z * z - 2.0 - 1.0 / n + 4.0 * p * (n * q + 1.0));
  const double up = z * std::sqrt(z * z + 2.0 - 1.0 / n + 4.0 * p * (n * q - 1.0));
  return {x == 0.0 ? 0.0 : std::max(0.0, (centre - 1.0 - down) / width),
          x == n ? 1.0 : std::min(1.0, (centre + 1.0 + up) / width)};
}

Interval clopper_pearson(const Proportion& of, double level) {
  const double tail = 0.5 - 0.5 * level, x = of.successes, n = of.trials;
  return {x == 0.0 ? 0.0 : beta_quantile(tail, x, n - x + 1.0),
          x == n ? 1.0 : beta_quantile(1.0 - tail, x + 1.0, n - x)};
}

Interval agresti_coull(const Proportion& of, double level) {
  const double z = reach(level), n = of.trials + z * z, p = (of.successes + 0.5 * z * z) / n;
  const double width = z * std::sqrt(p * (1.0 - p) / n);
  return {p - width, p + width};
}

Interval jeffreys(const Proportion& of, double level) {
  const double tail = 0.5 - 0.5 * level, a = of.successes + 0.5, b = of.trials - of.successes + 0.5;
  return {of.successes == 0.0 ? 0.0 : beta_quantile(tail, a, b),
          of.successes == of.trials ? 1.0 : beta_quantile(1.0 - tail, a, b)};
}

Interval newcombe_difference(const Proportion& a, const Proportion& b, double level) {
  const Interval of_a = wilson(a, level), of_b = wilson(b, level);
  const double p = a.share(), q = b.share();
  return {p - q - std::hypot(p - of_a.low, of_b.high - q),
          p - q + std::hypot(of_a.high - p, q - of_b.low)};
}

double fisher_exact(const Proportion& a, const Proportion& b) {
  const double total = a.successes + b.successes, n = a.trials + b.trials;
  const auto log_probability = [&](double x) {
    return log_choose(a.trials, x) + log_choose(b.trials, total - x) - log_choose(n, total);
  };
  // Tables as likely as the observed one count too, though rounding may put them just above.
  const double limit = log_probability(a.successes) + 1e-7;
  double p = 0.0;
  for (double x = std::max(0.0, total - b.trials); x <= std::min(total, a.trials); x += 1.0)
    if (const double here = log_probability(x); here <= limit) p += std::exp(here);
  return std::min(1.0, p);
}

double binomial_test(const Proportion& of, double chance) {
  const auto log_probability = [&](double x) {
    const double failures = of.trials - x;
    return log_choose(of.trials, x) + (x > 0.0 ? x * std::log(chance) : 0.0) +
           (failures > 0.0 ? failures * std::log1p(-chance) : 0.0);
  };
  const double observed = log_probability(of.successes), limit = observed + 1e-7;
  if (!(observed > -std::numeric_limits<double>::infinity())) return 0.0;
  double p = 0.0;
  for (double x = 0.0; x <= of.trials; x += 1.0)
    if (const double here = log_probability(x); here <= limit) p += std::exp(here);
  return std::min(1.0, p);
}

}  // namespace statistics
}  // namespace tractus
