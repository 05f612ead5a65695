#include "lab/signal/even_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace lab {
namespace {

double rounded(double t_s, double step_s) { return std::round(t_s / step_s) * step_s; }

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

TEST(EvenClock, IsFoundBehindStampsRoundedToATenthOfAMillisecondWithRowsLost) {
  std::vector<double> truth, t_s;
  for (int k = 0; k < 6000; ++k)
    if (k % 997 > 3) truth.push_back(k / 3000.0);  // four rows lost now and then
  for (const double t : truth) t_s.push_back(rounded(t, 1e-4));
  restore_even_clock(t_s);
  EXPECT_LT(farthest(t_s, truth), 2e-6);
}

TEST(EvenClock, IsFoundWhereStampsHalfWayBetweenTwoStepsAreAllRoundedDown) {
  std::vector<double> truth, t_s;
  for (int k = 0; k < 32000; ++k)
    if (k % 397 > 3) truth.push_back(k / 4000.0);
  for (const double t : truth) t_s.push_back(std::ceil(t / 1e-4 - 0.5 - 1e-6) * 1e-4);
  restore_even_clock(t_s);
  for (std::size_t k = 1; k < truth.size(); ++k)
    ASSERT_NEAR(t_s[k] - t_s[0], truth[k] - truth[0], 4e-6) << k;  // the rounding's are 5e-5
}

TEST(EvenClock, LeavesAClockThatJittersAsItIs) {
  std::mt19937_64 random(3);
  std::normal_distribution<> deviation_s(0.0, 3e-5);
  std::vector<double> t_s;
  for (int k = 0; k < 2000; ++k) t_s.push_back(rounded(k / 1000.0 + deviation_s(random), 1e-6));
  const std::vector<double> before = t_s;
  restore_even_clock(t_s);
  EXPECT_EQ(t_s, before);
}

TEST(EvenClock, LeavesStampsThatWereNeverRounded) {
  std::vector<double> t_s;
  for (int k = 0; k < 2000; ++k) t_s.push_back(k / 3000.0);
  const std::vector<double> before = t_s;
  restore_even_clock(t_s);
  EXPECT_EQ(t_s, before);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
