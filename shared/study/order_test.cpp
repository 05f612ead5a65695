#include "study/order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace tractus {
namespace study {
namespace {

using Pairs = std::map<std::pair<int, int>, int>;

/// How often each scenario stands at each place, and directly after each other one.
struct Balance {
  Pairs at_place, after;
};

Balance balance_of(const std::vector<std::vector<int>>& rows) {
  Balance out;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      ++out.at_place[{int(i), row[i]}];
      if (i > 0) ++out.after[{row[i - 1], row[i]}];
    }
  return out;
}

bool all_are(const Pairs& counts, std::size_t how_many, int each) {
  return counts.size() == how_many &&
         std::ranges::all_of(counts, [&](const auto& one) { return one.second == each; });
}

// The definition of a Williams design, counted: for k = 4 each of the 12 ordered pairs once in 4
// rows, for k = 5 each of the 20 twice in 10.
TEST(WilliamsSquare, FollowsEachScenarioByEachOtherEquallyOften) {
  for (const int k : {2, 3, 4, 5, 6, 7}) {
    const auto rows = williams_square(k);
    const int each = k % 2 == 0 ? 1 : 2;
    ASSERT_EQ(rows.size(), std::size_t(each * k));
    const auto counted = balance_of(rows);
    EXPECT_TRUE(all_are(counted.at_place, std::size_t(k * k), each)) << k;
    EXPECT_TRUE(all_are(counted.after, std::size_t(k * (k - 1)), each)) << k;
  }
  EXPECT_EQ(williams_square(1), std::vector<std::vector<int>>{{0}});
}

TEST(Order, HoldsEveryScenarioAsOftenAsThePlanSays) {
  for (const auto ordering : {Ordering::random, Ordering::balanced})
    for (int participant = 0; participant < 20; ++participant) {
      const auto order = order_of({4, 3, ordering, 7}, participant);
      ASSERT_EQ(order.size(), 12u);
      for (int s = 0; s < 4; ++s) EXPECT_EQ(std::ranges::count(order, s), 3);
    }
}

TEST(Order, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const OrderPlan plan{4, 3, Ordering::random, 7}, other{4, 3, Ordering::random, 8};
  EXPECT_EQ(order_of(plan, 3), order_of(plan, 3));
  int same = 0;
  for (int p = 0; p < 50; ++p) same += order_of(plan, p) == order_of(other, p);
  EXPECT_EQ(same, 0);  // 12!/(3!)^4 = 369600 orders: two alike among 50 would be chance of 1e-4
}

TEST(Order, DiffersBetweenParticipants) {
  std::set<std::vector<int>> seen;
  for (int p = 0; p < 50; ++p) seen.insert(order_of({4, 3, Ordering::random, 7}, p));
  EXPECT_EQ(seen.size(), 50u);
}

TEST(BalancedOrder, UsesEveryRowOnceInEveryBlockAmongAsManyParticipantsAsThereAreRows) {
  for (const int k : {3, 4}) {
    const int rows = int(williams_square(k).size());
    for (int block = 0; block < 3; ++block) {
      std::vector<std::vector<int>> blocks;
      for (int p = 0; p < rows; ++p) {
        const auto order = order_of({k, 3, Ordering::balanced, 11}, p);
        blocks.emplace_back(order.begin() + block * k, order.begin() + (block + 1) * k);
      }
      const auto counted = balance_of(blocks);
      EXPECT_TRUE(all_are(counted.at_place, std::size_t(k * k), rows / k)) << k << " " << block;
      EXPECT_TRUE(all_are(counted.after, std::size_t(k * (k - 1)), rows / k)) << k << " " << block;
    }
  }
}

// Each place has each of the four scenarios with probability 1/4: of 4000 participants 1000 ± 27.
TEST(RandomOrder, FavoursNoScenarioAtAnyPlace) {
  Pairs at_place;
  for (int p = 0; p < 4000; ++p) {
    const auto order = order_of({4, 3, Ordering::random, 5}, p);
    for (std::size_t i = 0; i < order.size(); ++i) ++at_place[{int(i), order[i]}];
  }
  for (const auto& [_, count] : at_place) EXPECT_NEAR(count, 1000, 5 * 27);
}

TEST(Ordering, IsReadByTheNameItIsWrittenWith) {
  for (const auto ordering : {Ordering::random, Ordering::balanced})
    EXPECT_EQ(core::from_name<Ordering>(name(ordering)), ordering);
  EXPECT_FALSE(core::from_name<Ordering>("alphabetical"));
}

}  // namespace
}  // namespace study
}  // namespace tractus
