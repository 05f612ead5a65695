#include "effects/delayed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tractus {
namespace effects {
namespace {

TEST(Delay, IsThatOfTheFunctionLateOrEarly) {
  for (const double late_s : {7.3e-3, -7.3e-3, 0.5e-3}) {
    std::vector<double> t_s, y;
    for (int k = 0; k < 1000; ++k)
      t_s.push_back(k * 1e-3), y.push_back(std::sin(20.0 * t_s.back()));
    delay(t_s, late_s, y);
    for (std::size_t k = 20; k < 980; ++k)
      EXPECT_NEAR(y[k], std::sin(20.0 * (t_s[k] - late_s)), 1e-6) << t_s[k];
  }
}

/// Evenly spaced samples are summed with the same weights everywhere; one stamp beside its place, and they are not.
TEST(Delay, IsTheSameOnAnEvenClockAndOnOneThatIsNearlySo) {
  for (const double late_s : {0.0023, -0.0017, 0.001, -0.9}) {
    std::vector<double> even_s, y;
    for (int k = 0; k < 1000; ++k)
      even_s.push_back(1.0 + k * 1e-3), y.push_back(std::sin(0.7 * k) + 0.01 * k);
    std::vector<double> uneven_s = even_s, other = y;
    uneven_s[500] += 1e-8;
    delay(even_s, late_s, y);
    delay(uneven_s, late_s, other);
    for (std::size_t k = 0; k < y.size(); ++k) EXPECT_NEAR(y[k], other[k], 1e-4) << k;
  }
}

TEST(Delay, HoldsTheFirstAndTheLastValue) {
  const std::vector<double> t_s{0.0, 1.0, 2.0};
  std::vector<double> y{5.0, 6.0, 8.0};
  delay(t_s, 10.0, y);
  EXPECT_EQ(y, (std::vector<double>{5.0, 5.0, 5.0}));
  y = {5.0, 6.0, 8.0};
  delay(t_s, -10.0, y);
  EXPECT_EQ(y, (std::vector<double>{8.0, 8.0, 8.0}));
}

}  // namespace
}  // namespace effects
}  // namespace tractus
