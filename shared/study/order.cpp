#include "study/order.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "core/require.hpp"

namespace tractus {
namespace study {
namespace {

/// Seeds of streams that have nothing to do with one another.
enum class Stream : std::uint32_t { participant = 1, rows = 2 };

std::mt19937_64 generator(std::uint64_t seed, Stream stream, int a, int b) {
  std::seed_seq sequence{std::uint32_t(seed), std::uint32_t(seed >> 32), std::uint32_t(stream),
                         std::uint32_t(a), std::uint32_t(b)};
  return std::mt19937_64(sequence);
}

/// 0 … limit−1 without bias. The standard's distributions differ between libraries; an order must
/// not.
std::uint64_t below(std::uint64_t limit, std::mt19937_64& random) {
  const std::uint64_t most = ~std::uint64_t{0} - ~std::uint64_t{0} % limit;
  std::uint64_t drawn = random();
  while (drawn >= most) drawn = random();
  return drawn % limit;
}

/// Fisher and Yates.
void shuffle(std::vector<int>& values, std::mt19937_64& random) {
  for (std::size_t left = values.size(); left > 1; --left)
    std::swap(values[left - 1], values[below(left, random)]);
}

std::vector<int> shuffled(const OrderPlan& plan, int participant) {
  std::vector<int> out;
  for (int r = 0; r < plan.repeats; ++r)
    for (int s = 0; s < plan.scenarios; ++s) out.push_back(s);
  auto random = generator(plan.seed, Stream::participant, participant, 0);
  shuffle(out, random);
  return out;
}

std::vector<int> balanced(const OrderPlan& plan, int participant) {
  const auto square = williams_square(plan.scenarios);
  const int rows = static_cast<int>(square.size());
  std::vector<int> out;
  for (int block = 0; block < plan.repeats; ++block) {
    std::vector<int> row_of(square.size());
    std::iota(row_of.begin(), row_of.end(), 0);
    auto random = generator(plan.seed, Stream::rows, participant / rows, block);
    shuffle(row_of, random);
    const auto& row = square[std::size_t(row_of[std::size_t(participant % rows)])];
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

}  // namespace

std::vector<std::vector<int>> williams_square(int k) {
  core::require(k >= 1, "a square has at least one condition");
  std::vector<std::vector<int>> rows;
  for (int shift = 0; shift < k; ++shift) {
    std::vector<int> row;
    // 0, 1, k−1, 2, k−2, …: neighbours differ by every number there is.
    for (int place = 0; place < k; ++place) {
      const int step = (place + 1) / 2;
      row.push_back((shift + (place % 2 == 1 ? step : k - step)) % k);
    }
    rows.push_back(std::move(row));
  }
  if (k % 2 == 0 || k == 1) return rows;
  for (int shift = 0; shift < k; ++shift) {
    auto mirrored = rows[std::size_t(shift)];
    std::ranges::reverse(mirrored);
    rows.push_back(std::move(mirrored));
  }
  return rows;
}

std::vector<int> order_of(const OrderPlan& plan, int participant) {
  core::require(plan.scenarios >= 1 && plan.repeats >= 1 && participant >= 0,
                "a plan has scenarios and repeats");
  return plan.ordering == Ordering::random ? shuffled(plan, participant)
                                           : balanced(plan, participant);
}

}  // namespace study
}  // namespace tractus
