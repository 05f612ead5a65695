/// Bounds of sequential looks against published and independent values.
#include "statistics/power/sequential_looks.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace statistics {
namespace {

void expect_bounds(const Looks& looks, const std::vector<double>& want, double within) {
  ASSERT_EQ(looks.bounds.size(), want.size());
  for (std::size_t k = 0; k < want.size(); ++k) EXPECT_NEAR(looks.bounds[k], want[k], within) << k;
}

constexpr double kFifths[] = {0.2, 0.4, 0.6, 0.8, 1.0};
const std::vector<double> kFive(std::begin(kFifths), std::end(kFifths));

// R 4.2.2, mvtnorm 1.1-3: each bound the root of pmvnorm (Miwa's algorithm, 512 steps). The first two
// are also those of Reboussin, DeMets, Kim & Lan 2000: 4.8769 3.3569 2.6803 2.2898 2.0310 (their
// coarser grid), 2.4380 2.4268 2.4101 2.3966 2.3859.
TEST(SequentialLooksTest, BoundsAgreeWithTheMultivariateNormal) {
  const auto late = sequential_looks(kFive, Spending::obrien_fleming, 0.05, 0.9);
  const auto even = sequential_looks(kFive, Spending::pocock, 0.05, 0.9);
  const auto three = sequential_looks({0.3, 0.7, 1.0}, Spending::obrien_fleming, 0.01, 0.9);
  ASSERT_TRUE(late && even && three);
  expect_bounds(*late, {4.8768849, 3.3570119, 2.6802801, 2.2898168, 2.0310320}, 1e-6);
  expect_bounds(*even, {2.4379767, 2.4268139, 2.4101938, 2.3966454, 2.3859846}, 1e-6);
  expect_bounds(*three, {4.9927256, 3.1583218, 2.5939058}, 1e-6);
  EXPECT_NEAR(late->nominal_p[4], 0.0422518, 2e-7);  // 2 pnorm(-2.0310320)
}

// The same by pmvnorm with a mean: drift 3.2787053 for 90 %, against 3.2415 of one look.
TEST(SequentialLooksTest, PowerAndSizeAgreeWithTheMultivariateNormal) {
  const auto looks = sequential_looks(kFive, Spending::obrien_fleming, 0.05, 0.9);
  ASSERT_TRUE(looks);
  EXPECT_NEAR(looks->inflation, 1.0230779, 1e-6);
  const std::vector<double> want = {0.0003241, 0.0996915, 0.4462783, 0.7459391, 0.9000000};
  for (std::size_t k = 0; k < want.size(); ++k)
    EXPECT_NEAR(looks->stopped_by[k], want[k], 1e-6) << k;
  EXPECT_NEAR(looks->mean_share, 0.7415534, 1e-6);
}

TEST(SequentialLooksTest, OneLookIsTheOrdinaryTest) {
  const auto one = sequential_looks({1.0}, Spending::pocock, 0.05, 0.8);
  ASSERT_TRUE(one);
  EXPECT_NEAR(one->bounds[0], 1.9599640, 1e-6);
  EXPECT_NEAR(one->inflation, 1.0, 1e-9);
  EXPECT_NEAR(one->mean_share, 1.0, 1e-12);
}

TEST(SequentialLooksTest, RefusesSharesThatDoNotIncreaseToOne) {
  const auto why = [](const std::vector<double>& shares) {
    const auto looks = sequential_looks(shares, Spending::pocock, 0.05, 0.8);
    return looks ? "" : looks.error().what;
  };
  EXPECT_EQ(why({}), "looks: 1 to 50 looks are expected");
  EXPECT_EQ(why({0.5, 0.5, 1.0}), "looks: the shares of the data should increase");
  EXPECT_EQ(why({0.5, 0.9}), "looks: the last share of the data should be 1");
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
