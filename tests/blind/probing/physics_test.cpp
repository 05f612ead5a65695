/// The generator's own physics against answers known by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "probing/generate.hpp"
#include "probing/judge.hpp"

namespace blind {
namespace {

Base one_layer() {
  Base base;
  base.layers = {{0.0, 0.02, 4000.0, 2000.0, 0.001}};
  base.rotary = {0.02, 0.01, 0.35};
  return base;
}

Moment at(double x, double v, double a = 0) {
  Moment m;
  m.x_m = x;
  m.v_m_s = v;
  m.a_m_s2 = a;
  return m;
}

/// Drives a law along x = A sin(2π f t) about 10 mm for whole periods; returns the work put in over
/// the last one.
double work_per_period(Physics& physics, double amplitude, double frequency,
                       std::vector<double>* forces = nullptr) {
  const int periods = 4, steps = 20000;
  const double dt = 1.0 / frequency / steps, w = 2 * std::numbers::pi * frequency;
  const auto moment = [&](int i) {
    Moment m = at(0.01 + amplitude * std::sin(w * i * dt), amplitude * w * std::cos(w * i * dt));
    m.t_s = i * dt;
    return m;
  };
  physics.begin({}, moment(0));
  double work = 0;
  for (int i = 0; i < periods * steps; ++i) {
    const double force = physics.force(moment(i));
    if (i >= (periods - 1) * steps) {
      work += force * moment(i).v_m_s * dt;
      if (forces != nullptr) forces->push_back(force);
    }
    physics.step(moment(i), moment(i + 1));
  }
  return work;
}

Physics law(const std::string& id, const Parameters& parameters, double stiffness = 4000,
            double damping = 0) {
  Base base = one_layer();
  base.layers[0].stiffness_N_per_m = stiffness;
  base.layers[0].damping_Ns_per_m = damping;
  return {base, {{id, parameters}}, 1};
}

TEST(BlindProbing, BaseIsSpringAndDamperInsideTheLayerAndNothingOutside) {
  const Physics physics(one_layer(), {}, 1);
  EXPECT_DOUBLE_EQ(physics.force(at(0.006, 0.003)), 4000 * 0.005 + 2000 * 0.003);
  EXPECT_DOUBLE_EQ(physics.force(at(-0.001, 0.003)), 0.0);
  EXPECT_DOUBLE_EQ(physics.force(at(0.021, 0.003)), 0.0);
}

TEST(BlindProbing, CoulombFrictionTakesFourAmplitudesOfWorkPerPeriod) {
  Physics physics = law("coulomb_friction", {{"friction_N", 2.5}});
  EXPECT_NEAR(work_per_period(physics, 0.002, 1.0), 4 * 2.5 * 0.002, 2e-6);
}

TEST(BlindProbing, MaxwellBranchLosesItsAnalyticWork) {
  // k'' = k wτ / (1 + w²τ²); work per period = π k'' A².
  Physics physics =
      law("viscoelastic_relaxation", {{"stiffness_N_per_m", 3000.0}, {"time_constant_s", 0.1}}, 0);
  const double wt = 2 * std::numbers::pi * 2.0 * 0.1, a = 0.001;
  const double expected = std::numbers::pi * 3000 * wt / (1 + wt * wt) * a * a;
  EXPECT_NEAR(work_per_period(physics, a, 2.0) / expected, 1.0, 2e-3);
}

TEST(BlindProbing, HysteresisSaturatesAtStiffnessTimesYield) {
  Physics physics =
      law("hysteresis", {{"stiffness_N_per_m", 5000.0}, {"yield_displacement_m", 4e-4}}, 0);
  std::vector<double> forces;
  work_per_period(physics, 0.005, 0.5, &forces);
  EXPECT_NEAR(*std::ranges::max_element(forces), 2.0, 1e-4);
  EXPECT_NEAR(*std::ranges::min_element(forces), -2.0, 1e-4);
}

TEST(BlindProbing, BacklashMakesTheLoopOfAPlay) {
  // The bone's depth lags by half the gap both ways, so the spring gives back more than it took: −
  // gap · K · (2A − gap).
  Physics physics = law("backlash", {{"gap_m", 4e-4}, {"of_hand", 0.0}});
  EXPECT_NEAR(work_per_period(physics, 0.002, 1.0), -4e-4 * 4000 * (2 * 0.002 - 4e-4), 2e-6);
}

TEST(BlindProbing, ForceLawsHaveTheirHandValues) {
  const Moment m = at(0.006, -0.004, 0.5);
  EXPECT_NEAR(law("inertia", {{"mass_kg", 3.0}}).force(m), 20.0 + 1.5, 1e-12);
  EXPECT_NEAR(law("quadratic_drag", {{"coefficient_Ns2_per_m2", 5e4}}).force(m), 20.0 - 0.8, 1e-12);
  EXPECT_NEAR(law("depth_friction", {{"slope_N_per_m", 200.0}}).force(m), 20.0 - 1.2, 1e-12);
  const Parameters stribeck = {
      {"friction_N", 2.0}, {"breakaway_N", 4.0}, {"stribeck_velocity_m_s", 0.004}};
  EXPECT_NEAR(law("stribeck_friction", stribeck).force(m), 20.0 - 2.0 - 2.0 * std::exp(-1.0),
              1e-12);
  const Parameters ripple = {
      {"amplitude_N", 1.5}, {"period_m", 0.002}, {"phase_rad", std::numbers::pi / 2}};
  EXPECT_NEAR(law("force_ripple", ripple).force(m), 20.0 + 1.5, 1e-9);
  Moment turning = m;
  turning.omega_rad_s = -3.0;
  EXPECT_NEAR(law("rotation_coupling", {{"coefficient_s_per_rad", 0.1}}).force(turning), 20.0 / 1.3,
              1e-12);
}

TEST(BlindProbing, DelayAndBiasActOnTheRecord) {
  std::vector<double> ramp(1001);
  for (std::size_t i = 0; i < ramp.size(); ++i)
    ramp[i] = static_cast<double>(i) * kFineStep_s * 100;
  const std::vector<double> torque_Nm(1001, 0.02);
  const auto out = as_recorded(ramp, torque_Nm,
                               {{"time_delay", {{"delay_s", 0.01}}},
                                {"sensor_bias", {{"force_N", -1.0}}},
                                {"torque_crosstalk", {{"coefficient_per_m", 50.0}}}},
                               1);
  EXPECT_NEAR(out[1000], (0.05 - 0.01) * 100 - 1.0 + 1.0, 1e-9);
}

TEST(BlindProbing, HandBalancesTheBoneAtEveryInstant) {
  TrialPlan plan;
  plan.duration_s = 2;
  plan.low_m = 0.002;
  plan.high_m = 0.015;
  plan.seed = 3;
  Physics loop(one_layer(), {{"inertia", {{"mass_kg", 8.0}}}}, 1);
  const TrialContext trial{0, 2, 0.02, 3};
  const Series series = move(plan, loop, trial);
  Physics again(one_layer(), {{"inertia", {{"mass_kg", 8.0}}}}, 1);
  const auto forces = evaluate(series, again, trial);
  double worst = 0;
  for (std::size_t i = 10; i + 1 < forces.size(); ++i)
    worst = std::max(worst, std::abs(forces[i] - series.force_N[i]));
  EXPECT_LT(worst, 0.02);
}

TEST(BlindProbing, SetComesToItsStrengthAndIsTheSameTwice) {
  Request request;
  request.seed = 5;
  request.kind = "single";
  request.ids = {"quadratic_drag"};
  request.trials = 2;
  request.duration_s = 3;
  const GeneratedSet a = generate(request), b = generate(request);
  ASSERT_EQ(a.outcomes.size(), 1u);
  EXPECT_GE(a.outcomes[0].strength, 0.04);
  EXPECT_LE(a.outcomes[0].strength, 0.10);
  EXPECT_NEAR(a.floor_N, 0.05, 0.005);
  EXPECT_EQ(a.trials[1].force_N, b.trials[1].force_N);
}

TEST(BlindProbing, BiasIsAbsorbedUnlessTheEquilibriumIsKnown) {
  SetPlan plan;
  plan.truth = one_layer();
  std::vector<JudgedPoint> points;
  for (int i = 0; i < 500; ++i)
    points.push_back({0.01 + 0.004 * std::sin(0.1 * i), 4e-3 * std::cos(0.1 * i), {2.0}});
  EXPECT_LT(projected_rms(points, plan)[0], 1e-9);
  plan.supplied.fixed = {"/base/layers/*/equilibrium_m"};
  EXPECT_GT(projected_rms(points, plan)[0], 0.1);
  plan.supplied.fixed = {"/base/layers/*/stiffness_N_per_m", "/base/layers/*/damping_Ns_per_m",
                         "/base/layers/*/start_m", "/base/layers/*/equilibrium_m"};
  EXPECT_DOUBLE_EQ(projected_rms(points, plan)[0], 2.0);  // nothing is left to hide it
}

}  // namespace
}  // namespace blind
