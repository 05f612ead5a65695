#include "statistics/summary/cutoff.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/try.hpp"
#include "statistics/summary/summary.hpp"

namespace tractus::statistics {
namespace {

std::vector<double> sorted(const Vector& values) {
  std::vector<double> out(values.begin(), values.end());
  std::ranges::sort(out);
  return out;
}

/// Share of `values` that are at most `bound`.
double share_at_most(const Vector& values, double bound) {
  return double((values.array() <= bound).count()) / double(values.size());
}

/// Chance that a value of `low` lies below one of `high`, ties counted half.
double chance_below(const Vector& low, const Vector& high) {
  double wins = 0.0;
  for (const double a : low)
    for (const double b : high) wins += a < b ? 1.0 : a == b ? 0.5 : 0.0;
  return wins / double(low.size() * high.size());
}

/// For scores that should be low.
Cut lowest_cut(const Vector& experts, const Vector& novices, const std::vector<double>& all) {
  Cut best;
  best.youden = -2.0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i] == all[i + 1]) continue;
    Cut cut;
    cut.bound = 0.5 * (all[i] + all[i + 1]);
    cut.sensitivity = share_at_most(experts, cut.bound);
    cut.specificity = 1.0 - share_at_most(novices, cut.bound);
    cut.youden = cut.sensitivity + cut.specificity - 1.0;
    if (cut.youden > best.youden + 1e-12) best = cut;
  }
  best.area = chance_below(experts, novices);
  return best;
}

}  // namespace

core::Result<double> mean_bound(const Vector& values, double k) {
  if (values.size() < 2)
    return core::bad_input("a mean with its deviation needs at least two values");
  const Summary of = summary(values);
  return of.mean + k * of.deviation;
}

core::Result<double> percentile(const Vector& values, double share) {
  if (values.size() == 0 || !(share >= 0.0 && share <= 1.0))
    return core::bad_input("a percentile needs at least one value and a share from 0 to 1");
  const auto all = sorted(values);
  const double h = share * double(all.size() - 1);
  const auto below = std::size_t(std::floor(h));
  if (below + 1 >= all.size()) return all.back();
  return all[below] + (h - double(below)) * (all[below + 1] - all[below]);
}

core::Result<Cut> youden_cut(const Vector& experts, const Vector& novices, Passing passing) {
  if (experts.size() == 0 || novices.size() == 0)
    return core::bad_input("a cut needs values of experts and of novices");
  // A score that should be high is one that should be low with its sign turned.
  const double sign = passing == Passing::at_most ? 1.0 : -1.0;
  const Vector good = sign * experts, poor = sign * novices;
  Vector both(good.size() + poor.size());
  both << good, poor;
  const auto all = sorted(both);
  if (all.front() == all.back()) return core::bad_input("all values are the same");
  Cut out = lowest_cut(good, poor, all);
  out.bound *= sign;
  return out;
}

}  // namespace tractus::statistics
