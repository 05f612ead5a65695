#include "bench/statistics/exact.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <map>
#include <utility>

namespace tractus {
namespace bench {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_100;

}  // namespace

std::vector<double> exact_coefficients(const std::vector<std::vector<double>>& rows,
                                       const std::vector<double>& y) {
  const std::size_t p = rows[0].size();
  std::vector<std::vector<Exact>> a(p, std::vector<Exact>(p + 1, 0));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < p; ++j) {
      for (std::size_t k = 0; k < p; ++k) a[j][k] += Exact(rows[i][j]) * Exact(rows[i][k]);
      a[j][p] += Exact(rows[i][j]) * Exact(y[i]);
    }
  for (std::size_t j = 0; j < p; ++j) {
    std::size_t best = j;
    for (std::size_t i = j; i < p; ++i)
      if (abs(a[i][j]) > abs(a[best][j])) best = i;
    std::swap(a[j], a[best]);
    for (std::size_t i = 0; i < p; ++i) {
      if (i == j) continue;
      const Exact factor = a[i][j] / a[j][j];
      for (std::size_t k = j; k <= p; ++k) a[i][k] -= factor * a[j][k];
    }
  }
  std::vector<double> out;
  for (std::size_t j = 0; j < p; ++j) out.push_back(static_cast<double>(Exact(a[j][p] / a[j][j])));
  return out;
}

double exact_f(const std::vector<std::string>& labels, const std::vector<double>& values) {
  std::map<std::string, std::pair<Exact, Exact>> groups;  // sum, count
  Exact sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    groups[labels[i]].first += Exact(values[i]);
    groups[labels[i]].second += 1;
    sum += Exact(values[i]);
  }
  const Exact n = static_cast<double>(values.size()), k = static_cast<double>(groups.size());
  Exact between = 0, within = 0;
  for (const auto& [_, group] : groups) {
    const Exact d = group.first / group.second - sum / n;
    between += group.second * d * d;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& group = groups[labels[i]];
    const Exact d = Exact(values[i]) - group.first / group.second;
    within += d * d;
  }
  return static_cast<double>(Exact((between / (k - 1)) / (within / (n - k))));
}

ExactSummary exact_summary(const std::vector<double>& values) {
  const Exact n = static_cast<double>(values.size());
  Exact sum = 0, squares = 0, lagged = 0;
  for (const double v : values) sum += Exact(v);
  const Exact mean = sum / n;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Exact d = Exact(values[i]) - mean;
    squares += d * d;
    if (i + 1 < values.size()) lagged += d * (Exact(values[i + 1]) - mean);
  }
  return {static_cast<double>(mean), static_cast<double>(Exact(sqrt(Exact(squares / (n - 1))))),
          static_cast<double>(Exact(lagged / squares))};
}

}  // namespace bench
}  // namespace tractus
