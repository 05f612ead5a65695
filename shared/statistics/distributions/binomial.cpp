#include "statistics/distributions/binomial.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace tractus {
namespace statistics::binomial {
namespace {

constexpr std::uint32_t kEmpty = 0xffffffffu;

std::uint64_t hash_of(const Matrix& columns, Eigen::Index row) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ull;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    // 0.0 takes the sign off a zero: equal numbers, equal bits.
    hash ^= std::bit_cast<std::uint64_t>(columns(row, j) + 0.0);
    hash *= 0xff51afd7ed558ccdull;
    hash ^= hash >> 32;
  }
  return hash;
}

bool same(const Matrix& columns, Eigen::Index a, Eigen::Index b) {
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    if (columns(a, j) != columns(b, j)) return false;
  return true;
}

}  // namespace

double log_coefficients(const Counts& counts) {
  const auto ln_choose = [](double m, double y) {
    return std::lgamma(m + 1.0) - std::lgamma(y + 1.0) - std::lgamma(m - y + 1.0);
  };
  double sum = 0.0;
  for (Eigen::Index i = 0; i < counts.trials.size(); ++i)
    sum += ln_choose(counts.trials[i], counts.successes[i]);
  return sum;
}

std::optional<Merged> merged(const Matrix& columns, const Counts& counts) {
  const Eigen::Index n = columns.rows();
  std::vector<std::uint32_t> table(std::bit_ceil(static_cast<std::size_t>(n) + 1), kEmpty);
  std::vector<Eigen::Index> kept;
  std::vector<double> successes, trials;
  for (Eigen::Index i = 0; i < n; ++i) {
    std::size_t at = hash_of(columns, i) & (table.size() - 1);
    while (table[at] != kEmpty && !same(columns, kept[table[at]], i))
      at = (at + 1) & (table.size() - 1);
    if (table[at] == kEmpty) {
      if (2 * (std::ssize(kept) + 1) > n) return std::nullopt;
      table[at] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(i);
      successes.push_back(0.0);
      trials.push_back(0.0);
    }
    successes[table[at]] += counts.successes[i];
    trials[table[at]] += counts.trials[i];
  }
  const auto size = std::ssize(kept);
  return Merged{
      columns(kept, Eigen::all),
      {Eigen::Map<Vector>(successes.data(), size), Eigen::Map<Vector>(trials.data(), size)}};
}

}  // namespace statistics::binomial
}  // namespace tractus
