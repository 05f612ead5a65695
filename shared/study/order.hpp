/// The order in which a participant of a study meets its scenarios.
#pragma once

#include <cstdint>
#include <vector>

#include "core/named.hpp"

namespace tractus::study {

enum class Ordering : unsigned char {
  random,   ///< every participant a shuffle of all trials of their own [Probing, section 5]
  balanced  ///< in blocks, each scenario once per block, by rows of a Williams square
};
constexpr auto words(Ordering) {
  return std::to_array<core::Word<Ordering>>(
      {{Ordering::random, "random"}, {Ordering::balanced, "balanced"}});
}
using core::name;

/// What an order follows from. The same plan gives the same orders on every machine.
struct OrderPlan {
  int scenarios = 4;  ///< k, ≥ 1
  int repeats = 3;    ///< of each, ≥ 1
  Ordering ordering = Ordering::random;
  std::uint64_t seed = 1;
};

/// Rows of a Williams design for k conditions: in all rows together every condition stands equally
/// often at every place and directly after every other one. k rows for an even k, 2k for an odd one
/// [Williams1949]. @pre k ≥ 1
std::vector<std::vector<int>> williams_square(int k);

/// Scenario numbers 0 … k−1, each `repeats` times, for the participant enrolled as the n-th (from
/// 0); it does not depend on how many follow.
///
/// balanced: block b is a row of the square; of every so many participants as there are rows, each
/// takes another row, and which one is a seeded shuffle of its own per block.
std::vector<int> order_of(const OrderPlan& plan, int participant);

}  // namespace tractus::study
