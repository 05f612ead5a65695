#include "models/probing_runtime.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace models {
namespace {

/// One layer, K = 4000 N/m, D = 2000 N·s/m, x0 = 0.
ProbingModel one_layer() {
  ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.0}};
  return model;
}

ProbingForces predicted(const ProbingModel& model, const ProbingMotion& motion) {
  const auto runtime = ProbingRuntime::make(model, 0.05);
  EXPECT_TRUE(runtime) << runtime.error().what;
  ProbingForces forces;
  runtime->predict(motion, forces);
  return forces;
}

ProbingMotion three_moments() {
  return {.t_s = {0.0, 1e-3, 2e-3},
          .x_m = {0.010, 0.010, 0.010},
          .v_m_s = {0.005, 0.0, -0.005},
          .a_m_s2 = {0.0, 0.0, 0.0},
          .theta_rad = {},
          .omega_rad_s = {},
          .tz_Nm = {}};
}

TEST(ProbingRuntime, AddsFrictionAgainstTheMotionAndTheSensorsBias) {
  ProbingModel model = one_layer();
  model.effects = {{"sensor_bias", {0.25}}, {"coulomb_friction", {2.0}}};
  const auto forces = predicted(model, three_moments());
  // 4000 · 0.01 = 40 N; ± 2000 · 0.005 = 10 N and ± 2 N; + 0.25 N.
  ASSERT_EQ(forces.fz_N.size(), 3u);
  EXPECT_NEAR(forces.fz_N[0], 52.25, 1e-12);
  EXPECT_NEAR(forces.fz_N[1], 40.25, 1e-12);
  EXPECT_NEAR(forces.fz_N[2], 28.25, 1e-12);
  EXPECT_TRUE(forces.tz_Nm.empty());
}

}  // namespace
}  // namespace models
