#include "station/rig/linear_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace rig {
namespace {

constexpr double kDt_s = 1e-4;

void drive(LinearAxis& axis, double speed_m_s, double load_N, int steps) {
  for (int k = 0; k < steps; ++k) axis.drive(speed_m_s, load_N, kDt_s);
}

// 667 N, 180 N at 0.15 m/s and 0.23 m/s are published [Probing, section 3].
TEST(LinearAxis, HasThePublishedThrust) {
  const LinearAxis axis{{}};
  EXPECT_EQ(axis.thrust_N(0.0), 667.0);
  EXPECT_NEAR(axis.thrust_N(0.15), 180.0, 1e-9);
  EXPECT_NEAR(axis.thrust_N(-0.15), 180.0, 1e-9);
  EXPECT_EQ(axis.thrust_N(0.23), 0.0);
  EXPECT_EQ(axis.thrust_N(1.0), 0.0);
}

TEST(LinearAxis, LagsBehindItsCommandByItsTimeConstant) {
  // v(τ) = v (1 − 1/e): 0.01 · 0.632121 after 2 ms = 20 steps; 0.01 / 2 ms = 5 m/s² takes 15 N.
  LinearAxis axis{{}};
  drive(axis, 0.01, 0.0, 20);
  EXPECT_NEAR(axis.v_m_s(), 0.00632121, 1e-8);
  // In all it stays v τ behind: x(t) = v (t − τ) for t ≫ τ: 0.01 · 0.098.
  drive(axis, 0.01, 0.0, 980);
  EXPECT_NEAR(axis.x_m(), 0.00098, 1e-6);
}

TEST(LinearAxis, AcceleratesNoFasterThanItsThrustAllows) {
  // With 30 kg, 667 N give 22.2 m/s²: 0.1 m/s is far off after 1 ms (0.0222 m/s, less what the
  // curve loses on the way: under 11 %).
  LinearAxis axis{{.mass_kg = 30.0}};
  drive(axis, 0.1, 0.0, 10);
  EXPECT_LT(axis.v_m_s(), 0.02224);
  EXPECT_GT(axis.v_m_s(), 0.0198);
  // A push along the motion helps, one against it hinders: ± 150 N / 30 kg over 1 ms = ± 5 mm/s.
  LinearAxis helped{{.mass_kg = 30.0}}, hindered{{.mass_kg = 30.0}};
  drive(helped, 0.1, 150.0, 10);
  drive(hindered, 0.1, -150.0, 10);
  EXPECT_NEAR(helped.v_m_s() - axis.v_m_s(), 0.005, 5e-4);
  EXPECT_NEAR(axis.v_m_s() - hindered.v_m_s(), 0.005, 5e-4);
}

TEST(LinearAxis, GoesNoFasterThanItsTopSpeed) {
  LinearAxis axis{{}};
  drive(axis, 5.0, 0.0, 3000);
  EXPECT_LE(axis.v_m_s(), 0.23);
  LinearAxis back{{}};
  drive(back, 0.1, 0.0, 5000);
  drive(back, -5.0, 0.0, 2000);
  EXPECT_GE(back.v_m_s(), -0.23);
}

TEST(LinearAxis, StandsAtEitherEndOfTheTravel) {
  LinearAxis axis{{}};
  EXPECT_TRUE(axis.at_inner_stop());
  drive(axis, -0.1, 0.0, 100);
  EXPECT_EQ(axis.x_m(), 0.0);
  EXPECT_EQ(axis.v_m_s(), 0.0);
  drive(axis, 0.15, 0.0, 10000);  // 1 s at 0.15 m/s: past 0.1 m
  EXPECT_EQ(axis.x_m(), 0.1);
  EXPECT_EQ(axis.v_m_s(), 0.0);
  EXPECT_TRUE(axis.at_outer_stop());
  drive(axis, -0.1, 0.0, 100);
  EXPECT_LT(axis.x_m(), 0.1);
}

TEST(LinearAxis, StallsOnlyWhenTheLoadStaysAboveTheThrust) {
  LinearAxis axis{{}};
  drive(axis, 0.0, 700.0, 40);  // 4 ms of 700 N > 667 N: borne
  EXPECT_FALSE(axis.stalled());
  drive(axis, 0.0, 600.0, 1);
  drive(axis, 0.0, 700.0, 45);
  EXPECT_FALSE(axis.stalled());
  drive(axis, 0.0, 700.0, 10);  // now more than 5 ms
  EXPECT_TRUE(axis.stalled());
}

TEST(LinearAxis, BrakesFromTopSpeedInUnderFourMilliseconds) {
  LinearAxis axis{{}};
  drive(axis, 0.22, 0.0, 1000);
  ASSERT_GT(axis.v_m_s(), 0.2);
  for (int k = 0; k < 39; ++k) axis.brake(kDt_s);  // 0.23 m/s at 60 m/s²: 3.83 ms
  EXPECT_EQ(axis.v_m_s(), 0.0);
}

TEST(LinearAxis, CountsWholeSteps) {
  LinearAxis axis{{}};
  drive(axis, 0.00123, 0.0, 777);
  EXPECT_NEAR(axis.counted_m(), axis.x_m(), 2.5e-6 + 1e-12);
  EXPECT_NEAR(std::remainder(axis.counted_m(), 5e-6), 0.0, 1e-12);
}

}  // namespace
}  // namespace rig
}  // namespace tractus
