#include "statistics/learning/cusum.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace statistics {
namespace {

struct Steps {
  double success, failure;
};

Steps lc_steps(const Rates& r) {
  return {std::log((1.0 - r.adequate) / (1.0 - r.inadequate)), std::log(r.adequate / r.inadequate)};
}

std::vector<double> path(const std::vector<bool>& failures, const Steps& steps) {
  std::vector<double> out;
  double sum = 0.0;
  for (const bool failure : failures)
    out.push_back(sum = std::max(0.0, sum + (failure ? steps.failure : steps.success)));
  return out;
}

/// Probabilities by successes and failures since the sum was last 0: the sum follows from them
/// without rounding piling up, so that equal sums are equal states. Failures that would bring the
/// sum to 0 are no state of their own.
struct States {
  int successes, failures;  // the largest that can be
  std::vector<double> chance;
  States(int trials, const Steps& steps)
      : successes(trials),
        failures(
            static_cast<int>(std::min<double>(trials, -trials * steps.success / steps.failure))),
        chance(static_cast<std::size_t>(successes + 1) * static_cast<std::size_t>(failures + 1)) {}
  double& at(int s, int f) {
    return chance[static_cast<std::size_t>(s) * static_cast<std::size_t>(failures + 1) +
                  static_cast<std::size_t>(f)];
  }
};

}  // namespace

core::Result<Rates> Rates::make(double adequate, double inadequate) {
  if (!(adequate > 0.0 && adequate < inadequate && inadequate < 1.0))
    return core::Error{core::Errc::out_of_range,
                       "failure rates: 0 < adequate < inadequate < 1 is needed"};
  return Rates{adequate, inadequate};
}

std::vector<double> lc_cusum(const std::vector<bool>& failures, const Rates& rates) {
  return path(failures, lc_steps(rates));
}

std::vector<double> deterioration_cusum(const std::vector<bool>& failures, const Rates& rates) {
  const Steps steps = lc_steps(rates);
  return path(failures, {-steps.success, -steps.failure});
}

OperatingCharacteristic lc_cusum_characteristic(const Rates& rates, double threshold,
                                                double failure, int trials) {
  core::require(
      threshold > 0.0 && failure >= 0.0 && failure <= 1.0 && trials >= 1 && trials <= 1000,
      "an operating characteristic has h > 0, a probability and 1 to 1000 trials");
  const Steps steps = lc_steps(rates);
  States now(trials, steps), next(trials, steps);
  now.at(0, 0) = 1.0;
  OperatingCharacteristic out;
  double signalled = 0.0;
  for (int t = 0; t < trials; ++t) {
    out.mean_run_length += 1.0 - signalled;
    for (int s = 0; s <= t; ++s)
      for (int f = 0; f <= std::min(t - s, now.failures); ++f) {
        double& chance = now.at(s, f);
        if (chance == 0.0) continue;
        for (const bool failed : {false, true}) {
          const int to_s = s + (failed ? 0 : 1), to_f = f + (failed ? 1 : 0);
          const double sum = to_s * steps.success + to_f * steps.failure;
          const double share = chance * (failed ? failure : 1.0 - failure);
          if (sum >= threshold)
            signalled += share;
          else
            (sum <= 0.0 ? next.at(0, 0) : next.at(to_s, to_f)) += share;
        }
        chance = 0.0;
      }
    std::swap(now, next);
    out.signalled_by.push_back(signalled);
  }
  return out;
}

SprtBounds sprt_bounds(double alpha, double beta) {
  core::require(alpha > 0.0 && beta > 0.0 && alpha + beta < 1.0, "both errors are less than all");
  return {std::log((1.0 - beta) / alpha), std::log(beta / (1.0 - alpha))};
}

Sprt sprt(const std::vector<bool>& failures, const Rates& rates, const SprtBounds& bounds) {
  const Steps steps = lc_steps(rates);
  Sprt out;
  int failed = 0, succeeded = 0;
  for (const bool failure : failures) {
    (failure ? failed : succeeded) += 1;
    const double sum = -failed * steps.failure - succeeded * steps.success;
    out.sums.push_back(sum);
    if (out.decided_at > 0 || (sum < bounds.upper && sum > bounds.lower)) continue;
    out.decided_at = out.sums.size();
    out.verdict = sum >= bounds.upper ? Sprt::Verdict::inadequate : Sprt::Verdict::adequate;
  }
  return out;
}

SprtCharacteristic sprt_characteristic(const Rates& rates, const SprtBounds& bounds, double failure,
                                       int trials) {
  core::require(failure >= 0.0 && failure <= 1.0 && trials >= 1 && trials <= 1000,
                "an operating characteristic has a probability and 1 to 1000 trials");
  const Steps steps = lc_steps(rates);
  std::vector<double> now{1.0}, next;  // undecided, by failures so far
  SprtCharacteristic out;
  for (int t = 1; t <= trials; ++t) {
    for (const double chance : now) out.mean_trials += chance;
    next.assign(static_cast<std::size_t>(t) + 1, 0.0);
    for (std::size_t f = 0; f < now.size(); ++f)
      for (const bool failed : {false, true}) {
        const std::size_t to = f + (failed ? 1 : 0);
        const double share = now[f] * (failed ? failure : 1.0 - failure);
        const double sum = -static_cast<double>(to) * steps.failure -
                           static_cast<double>(static_cast<std::size_t>(t) - to) * steps.success;
        if (sum >= bounds.upper)
          out.inadequate += share;
        else if (sum <= bounds.lower)
          out.adequate += share;
        else
          next[to] += share;
      }
    std::swap(now, next);
  }
  return out;
}

std::size_t first_at(const std::vector<double>& sums, double limit) {
  const auto at = std::ranges::find_if(sums, [&](double s) { return s >= limit - 1e-9; });
  return at == sums.end() ? 0 : static_cast<std::size_t>(at - sums.begin()) + 1;
}

}  // namespace statistics
}  // namespace tractus
