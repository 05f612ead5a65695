#include "statistics/cusum.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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

/// Successes and failures since the sum was last 0: the sum follows from them without rounding
/// piling up, so that equal sums are equal states.
using State = std::pair<int, int>;

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
  std::map<State, double> now{{{0, 0}, 1.0}};
  OperatingCharacteristic out;
  double signalled = 0.0;
  for (int t = 0; t < trials; ++t) {
    out.mean_run_length += 1.0 - signalled;
    std::map<State, double> next;
    for (const auto& [state, chance] : now)
      for (const bool failed : {false, true}) {
        const State to{state.first + (failed ? 0 : 1), state.second + (failed ? 1 : 0)};
        const double sum = to.first * steps.success + to.second * steps.failure;
        const double share = chance * (failed ? failure : 1.0 - failure);
        if (sum >= threshold)
          signalled += share;
        else
          next[sum <= 0.0 ? State{0, 0} : to] += share;
      }
    now = std::move(next);
    out.signalled_by.push_back(signalled);
  }
  return out;
}

}  // namespace statistics
