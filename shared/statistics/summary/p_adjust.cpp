#include "statistics/summary/p_adjust.hpp"

#include <algorithm>
#include <numeric>

#include "core/require.hpp"

namespace tractus {
namespace statistics {
namespace {

double factor(Adjustment how, double rank, double m, double harmonic) {
  switch (how) {
    case Adjustment::bonferroni:
      return m;
    case Adjustment::holm:
    case Adjustment::hochberg:
    case Adjustment::hommel:
      return m - rank + 1.0;
    case Adjustment::benjamini_hochberg:
      return m / rank;
    case Adjustment::benjamini_yekutieli:
      return harmonic * m / rank;
  }
  core::require(false, "every adjustment has its factor");
  return m;
}

/// Wright 1992, appendix: the largest of the Simes p-values of all intersections that a hypothesis
/// belongs to, from the sorted p.
std::vector<double> hommel_of_sorted(const std::vector<double>& p) {
  const std::size_t n = p.size();
  std::vector<double> out = p;
  for (std::size_t m = n; m > 1; --m) {
    const double size = static_cast<double>(m);
    double simes = 1.0;
    for (std::size_t i = 1; i <= m; ++i)
      simes = std::min(simes, size * p[n - m + i - 1] / static_cast<double>(i));
    for (std::size_t i = n - m; i < n; ++i) out[i] = std::max(out[i], simes);
    for (std::size_t i = 0; i < n - m; ++i) out[i] = std::max(out[i], std::min(simes, size * p[i]));
  }
  return out;
}

}  // namespace

std::vector<double> adjusted(const std::vector<double>& p, Adjustment how) {
  for (const double one : p) core::require(one >= 0.0 && one <= 1.0, "a p-value lies in [0, 1]");
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  if (how == Adjustment::hommel) {
    std::vector<double> sorted;
    for (const std::size_t i : order) sorted.push_back(p[i]);
    sorted = hommel_of_sorted(sorted);
    std::vector<double> out(p.size());
    for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = std::min(1.0, sorted[i]);
    return out;
  }
  const double m = static_cast<double>(p.size());
  double harmonic = 0.0;
  for (std::size_t i = 1; i <= p.size(); ++i) harmonic += 1.0 / static_cast<double>(i);
  std::vector<double> out(p.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    out[order[i]] =
        std::min(1.0, p[order[i]] * factor(how, static_cast<double>(i + 1), m, harmonic));
  if (how == Adjustment::holm)
    for (std::size_t i = 1; i < order.size(); ++i)
      out[order[i]] = std::max(out[order[i]], out[order[i - 1]]);
  else if (how != Adjustment::bonferroni)
    for (std::size_t i = order.size(); i-- > 1;)
      out[order[i - 1]] = std::min(out[order[i - 1]], out[order[i]]);
  return out;
}

}  // namespace statistics
}  // namespace tractus
