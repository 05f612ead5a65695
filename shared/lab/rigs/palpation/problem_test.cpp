#include "lab/rigs/palpation/problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "lab/identify/fit.hpp"
#include "lab/identify/free_air.hpp"
#include "lab/settings.hpp"
#include "models/palpation_runtime.hpp"

namespace tractus {
namespace lab {
namespace {

using math::Vec3;
using testing::HasSubstr;

/// Bone below z = 10 mm and beyond 9 mm along x and y: a floor and two walls, so that every way of
/// the probe meets one.
volume::Volume corner() {
  volume::Volume v;
  v.geometry.dims = {34, 34, 72};
  v.geometry.spacing_m = Vec3::Constant(0.5e-3);
  v.counts.assign(v.geometry.voxel_count(), 0);
  for (int k = 0; k < 72; ++k)
    for (int j = 0; j < 34; ++j)
      for (int i = 0; i < 34; ++i)
        if (k < 20 || i > 18 || j > 18) v.counts[v.offset(i, j, k)] = 1000;
  return v;
}

models::PalpationModel model(std::vector<effects::EffectInstance> uses = {}) {
  models::PalpationModel out;
  out.name = "corner";
  out.fixed = {"/base/length_m", "/base/point_spacing_m", "/base/youngs_modulus_Pa"};
  out.effects = std::move(uses);
  return out;
}

/// Simulated recordings of a model: presses and slides that differ from trial to trial, 200 Hz,
/// 5 µm, 0.01 N and 0.5 mN·m of noise.
trial::PalpationSet recordings(const models::PalpationModel& truth, int trials, int samples,
                               double times_faster = 1.0) {
  const auto runtime = models::PalpationRuntime::make(truth, corner());
  EXPECT_TRUE(runtime);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sd) -> Vec3 {
    return sd * Vec3(normal(random), normal(random), normal(random));
  };
  trial::PalpationSet set;
  set.folder = "set";
  for (int n = 0; n < trials; ++n) {
    trial::PalpationMeasurement m;
    m.id = "t" + std::to_string(n);
    m.file = m.id + ".csv";
    std::vector<math::Pose> poses;
    for (int k = 0; k < samples; ++k) {
      const double t = k / 200.0, w = (2.0 + 0.3 * n) * times_faster * t;
      const math::Quat down(
          Eigen::AngleAxisd(M_PI - 0.15 + 0.1 * std::sin(0.7 * w + n), Vec3::UnitX()));
      const Vec3 tip(6e-3 + 2.6e-3 * std::sin(w), 6e-3 + 2.6e-3 * std::cos(1.3 * w),
                     10.9e-3 + 0.9e-3 * std::cos(2.1 * w));
      m.t_s.push_back(t);
      poses.push_back({tip - 0.13 * (down * Vec3::UnitZ()), down});
    }
    const auto motion = models::PalpationMotion::through(m.t_s, poses);
    EXPECT_TRUE(motion);
    models::PalpationAnswer answer;
    runtime->predict(*motion, answer);
    for (int k = 0; k < samples; ++k) {
      const auto at = std::size_t(k);
      m.X_VH.push_back({poses[at].p + noise(5e-6), poses[at].q});
      m.wrench_H.push_back(
          {answer.wrench_H[at].force_N + noise(0.01), answer.wrench_H[at].torque_Nm + noise(5e-4)});
    }
    set.trials.push_back(std::move(m));
  }
  return set;
}

std::unique_ptr<Problem> problem_of(const models::PalpationModel& truth,
                                    const models::PalpationModel& given) {
  auto problem = make_palpation_problem(given, recordings(truth, 4, 500), corner(), {.threads = 1});
  EXPECT_TRUE(problem) << problem.error().what;
  return std::move(*problem);
}

const Estimate& estimate(const Fit& fit, const std::string& pointer) {
  return *std::ranges::find(fit.estimates, pointer, &Estimate::pointer);
}

TEST(PalpationProblem, LeavesVarianceOneWhereTheModelIsTrue) {
  const auto problem = problem_of(model(), model());
  const auto found = fit(*problem, {}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->whitened_rms, 1.0, 0.06);
  EXPECT_NEAR(found->rmse / found->noise_floor, 1.0, 0.08);
  EXPECT_NEAR(found->noise_floor, std::sqrt(3.0) * 0.01, 0.003);  // the sensor's, and a little
}

TEST(PalpationProblem, FindsBackTheNumbersOfTheBase) {
  models::PalpationModel wrong = model();
  wrong.base.torque_scale *= 1.2;
  wrong.base.radius_m *= 0.95;
  const auto problem = problem_of(model(), wrong);
  const auto found = fit(*problem, {}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  // c_f and s_f are felt as a product, s_t with c_f, r with c_f: the ratios are what is known.
  const double product =
      estimate(*found, "/base/force_factor_Nm").value * estimate(*found, "/base/force_scale").value;
  EXPECT_NEAR(product / (0.005 * 0.3), 1.0, 0.01);
  EXPECT_NEAR(
      estimate(*found, "/base/torque_scale").value / estimate(*found, "/base/force_scale").value,
      1.0, 0.01);
}

TEST(PalpationProblem, AForceRecordedALittleLateIsANumberOfTheRecordingAndNoEffect) {
  const auto problem = problem_of(model({{"time_delay", {1.5e-3}}}), model());
  const auto found = fit(*problem, {}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->whitened_rms, 1.0, 0.06);
  EXPECT_NEAR(estimate(*found, "/sensor/force_delay_s").value, 1.5e-3, 2e-4);
}

TEST(PalpationProblem, NoiseThatIsColouredIsInTheFloor) {
  // An autoregressive process of order 1: variance s²/(1 − a²) of steps s, correlated over 10 samples.
  constexpr double kStep_N = 0.01, kKept = 0.9;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  auto set = recordings(model(), 4, 500);
  for (auto& trial : set.trials) {
    Vec3 level = Vec3::Zero();
    for (math::Wrench& w : trial.wrench_H) {
      level = kKept * level + kStep_N * Vec3(normal(random), normal(random), normal(random));
      w.force_N += level;
    }
  }
  const double total_N =
      std::sqrt(3.0) * std::hypot(0.01, kStep_N / std::sqrt(1.0 - kKept * kKept));
  const auto problem = make_palpation_problem(model(), std::move(set), corner(), {.threads = 1});
  ASSERT_TRUE(problem) << problem.error().what;
  const auto found = fit(**problem, {}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->noise_floor / total_N, 1.0, 0.12);
}

/// A mass is told by the acceleration, which is the second derivative of what a tracker says; 40 µm
/// of its noise stay alike for 25 ms, as of one that filters.
TEST(PalpationProblem, AMassIsFoundThroughATrackerWhoseNoiseLingers) {
  const double mass_kg = 0.15, alike = std::exp(-0.005 / 0.025);
  auto set = recordings(model({{"probe_inertia", {mass_kg, 0.05}}}), 4, 500, 4.0);
  std::mt19937 random(8);
  std::normal_distribution<double> normal(0.0, 40e-6);
  for (auto& trial : set.trials) {
    Vec3 wander = Vec3::Zero();
    for (auto& pose : trial.X_VH) {
      const Vec3 fresh(normal(random), normal(random), normal(random));
      wander = alike * wander + std::sqrt(1.0 - alike * alike) * fresh;
      pose.p += wander;
    }
  }
  const auto problem = make_palpation_problem(model(), std::move(set), corner(), {.threads = 1});
  ASSERT_TRUE(problem) << problem.error().what;
  const auto found = fit(**problem, {{"probe_inertia"}}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(estimate(*found, "probe_inertia/mass_kg").value, mass_kg, 0.15 * mass_kg);
}

/// How much of a mass of 0.15 kg the samples in free air show of recordings with one of `mass_kg`.
double shown_in_air(double mass_kg) {
  std::vector<effects::EffectInstance> hidden;
  if (mass_kg > 0.0) hidden.push_back({"probe_inertia", {mass_kg, 0.05}});
  const auto problem = make_palpation_problem(model(), recordings(model(hidden), 4, 500, 4.0),
                                              corner(), {.threads = 1});
  EXPECT_TRUE(problem) << problem.error().what;
  const Residual residual(**problem, 1);
  const auto at = [&](const Structure& structure) {
    Solution out;
    out.structure = structure;
    out.parameters = (*problem)->parameters(structure);
    for (const Parameter& p : out.parameters)
      out.values.push_back(p.pointer == "probe_inertia/mass_kg"    ? 0.15
                           : p.pointer == "probe_inertia/centre_m" ? 0.05
                                                                   : p.start);
    return out;
  };
  const auto shown = share_in_free_air(residual, at({{"probe_inertia"}}), at({}), 0.05);
  EXPECT_TRUE(shown);
  return shown.value_or(-1.0);
}

TEST(PalpationProblem, FreeAirShowsAMassThatIsThereAndNoneThatIsNot) {
  EXPECT_NEAR(shown_in_air(0.15), 1.0, 0.1);
  EXPECT_NEAR(shown_in_air(0.075), 0.5, 0.1);
  EXPECT_NEAR(shown_in_air(0.0), 0.0, 0.1);
}

/// Friction does nothing where nothing is touched: free air says nothing of it.
TEST(PalpationProblem, FreeAirSaysNothingOfWhatActsInContactAlone) {
  const auto problem = problem_of(model({{"contact_friction", {0.15, 1.0}}}), model());
  Solution with, without;
  with.structure = {{"contact_friction"}};
  with.parameters = problem->parameters(with.structure);
  for (const Parameter& p : with.parameters)
    with.values.push_back(p.pointer == "contact_friction/coefficient" ? 0.15 : p.start);
  without.parameters = problem->parameters({});
  for (const Parameter& p : without.parameters) without.values.push_back(p.start);
  EXPECT_FALSE(share_in_free_air(Residual(*problem, 1), with, without, 0.05));
}

class AHiddenEffect : public testing::TestWithParam<effects::EffectInstance> {};

TEST_P(AHiddenEffect, IsFoundBackWithItsNumbers) {
  const effects::EffectInstance& use = GetParam();
  const auto problem = problem_of(model({use}), model());
  const auto base = fit(*problem, {}, {.threads = 1, .held_out = false});
  const auto found = fit(*problem, {{use.id}}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(base && found) << found.error().what;
  EXPECT_GT(base->whitened_rms, found->whitened_rms + 0.02);
  EXPECT_NEAR(found->whitened_rms, 1.0, 0.06);
  std::size_t next = 0;
  for (const Estimate& e : found->estimates) {
    if (e.pointer.starts_with("/") || e.pointer.ends_with("bends_shank")) continue;
    const bool turns = e.pointer.ends_with("direction_rad");  // the same after a whole turn
    const double off = e.value - use.values[next];
    EXPECT_NEAR(turns ? std::remainder(off, 2.0 * std::numbers::pi) : off, 0.0,
                std::max(0.05 * std::abs(use.values[next]), 3.0 * e.sd))
        << e.pointer;
    if (turns) {
      EXPECT_LE(std::abs(e.value), std::numbers::pi);
    }
    // Before it is widened for what all trials have in common, of which these have nothing.
    EXPECT_LT(e.sd / kSettings.palpation_thresholds.common_errors,
              0.25 * std::abs(use.values[next]))
        << e.pointer;
    ++next;
  }
}

INSTANTIATE_TEST_SUITE_P(Palpation, AHiddenEffect,
                         testing::Values(effects::EffectInstance{"probe_weight", {0.02, 0.06}},
                                         effects::EffectInstance{"pose_offset",
                                                                 {2e-4, -1.5e-4, 1e-4}},
                                         effects::EffectInstance{"contact_friction", {0.15, 1.0}},
                                         effects::EffectInstance{"time_delay", {0.012}},
                                         effects::EffectInstance{"tip_ball", {6e-4}},
                                         effects::EffectInstance{"shank_curvature", {6e-4, 3.5}}),
                         [](const auto& one) { return one.param.id; });

double share_of(const Problem& problem, Judgement judgement) {
  std::vector<double> values;
  for (const Parameter& p : problem.parameters({})) values.push_back(p.start);
  double found = 0.0, all = 0.0;
  for (int k = 0; k < problem.trials(); ++k) {
    const auto judged = problem.full_rate({}, values, k).judgement;
    found += double(std::ranges::count(judged, judgement)), all += double(judged.size());
  }
  return found / all;
}

/// Poses known within 5 µm and a sensor of 0.01 N: nothing but a fast turn of a contact's friction is unknown.
TEST(PalpationProblem, JudgesMostSamplesWhereTheMotionIsKnown) {
  EXPECT_GT(share_of(*problem_of(model(), model()), Judgement::judged), 0.75);
}

/// The largest tenth of the forces along the probe was cut off.
TEST(PalpationProblem, ASensorAtTheEndOfItsRangeIsNotJudgedNorFitted) {
  auto set = recordings(model(), 4, 500);
  std::vector<double> along;
  for (const auto& trial : set.trials)
    for (const math::Wrench& w : trial.wrench_H) along.push_back(w.force_N.z());
  std::ranges::sort(along);
  const double least_N = along[along.size() / 10];
  for (auto& trial : set.trials)
    for (math::Wrench& w : trial.wrench_H) w.force_N.z() = std::max(w.force_N.z(), least_N);
  const auto problem = make_palpation_problem(model(), std::move(set), corner(), {.threads = 1});
  ASSERT_TRUE(problem) << problem.error().what;
  EXPECT_NEAR(share_of(**problem, Judgement::saturated), 0.1, 0.02);
  const auto found = fit(**problem, {}, {.threads = 1, .held_out = false});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->rmse / found->noise_floor, 1.0, 0.08);
  const double product =
      estimate(*found, "/base/force_factor_Nm").value * estimate(*found, "/base/force_scale").value;
  EXPECT_NEAR(product / (0.005 * 0.3), 1.0, 0.01);
}

TEST(PalpationProblem, RefusesWhatCannotBeJudged) {
  const auto refusal = [](trial::PalpationSet set) {
    const auto problem = make_palpation_problem(model(), std::move(set), corner(), {.threads = 1});
    return problem ? "taken" : problem.error().what;
  };
  EXPECT_THAT(refusal(recordings(model(), 1, 20)), HasSubstr("set/t0.csv: 20 samples"));
  auto far = recordings(model(), 1, 300);
  for (auto& pose : far.trials[0].X_VH) pose.p += Vec3(-0.2, -0.2, 0.2);
  EXPECT_THAT(refusal(std::move(far)), HasSubstr("touch bone"));
  auto slow = recordings(model(), 1, 300);
  for (double& t : slow.trials[0].t_s) t *= 10.0;
  EXPECT_THAT(refusal(std::move(slow)), HasSubstr("20 samples per second"));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
