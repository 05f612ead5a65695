/// A probing set made here by hand: one layer or two, a prescribed motion, known noise. The forces
/// are written out, not taken from the product's law.
#include "lab/rigs/probing/problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/try.hpp"
#include "lab/identify/diagnosis.hpp"

namespace tractus {
namespace lab {
namespace {

using testing::HasSubstr;

constexpr double kStiffness = 3000.0, kDamping = 1200.0, kNoise_N = 0.05, kNoise_m = 5e-7;

struct Moment {
  double t_s, x_m, v_m_s, omega_rad_s;
};

/// In and out by sines of two periods, so that speeds and depths mix.
Moment moment(int trial, double t) {
  const double a = 2.0 * std::numbers::pi * (0.25 + 0.03 * trial), b = 2.7 * a;
  return {t, 0.012 + 0.008 * std::sin(a * t) + 0.002 * std::sin(b * t + trial),
          0.008 * a * std::cos(a * t) + 0.002 * b * std::cos(b * t + trial), 2.0 + trial % 3};
}

trial::ProbingSet set_of(const std::function<double(const Moment&)>& hidden_N, int trials = 6,
                         double rate_Hz = 500.0,
                         const std::function<Moment(int, double)>& motion = moment) {
  std::mt19937_64 random(5);
  std::normal_distribution<> normal;
  trial::ProbingSet set;
  set.folder = "made";
  for (int k = 0; k < trials; ++k) {
    trial::ProbingMeasurement m;
    m.id = "t" + std::to_string(k);
    m.file = m.id + ".csv";
    for (int i = 0; i < int(6.0 * rate_Hz); ++i) {
      const Moment at = motion(k, i / rate_Hz);
      m.t_s.push_back(at.t_s);
      m.x_m.push_back(at.x_m + kNoise_m * normal(random));
      m.fz_N.push_back(kStiffness * at.x_m + kDamping * at.v_m_s + hidden_N(at) +
                       kNoise_N * normal(random));
    }
    set.trials.push_back(std::move(m));
  }
  return set;
}

models::ProbingModel model_of(double stiffness = 3600.0, double damping = 1000.0) {
  models::ProbingModel model;
  model.name = "one layer";
  model.layers = {{0.0, 0.04, stiffness, damping, 0.0}};
  return model;
}

std::unique_ptr<Problem> made(trial::ProbingSet set,
                              const models::ProbingModel& model = model_of()) {
  auto problem = make_probing_problem(model, std::move(set));
  EXPECT_TRUE(problem) << problem.error().what;
  return problem ? std::move(*problem) : nullptr;
}

TEST(ProbingProblem, AForceRecordedALittleLateIsANumberOfTheRecordingAndNoEffect) {
  constexpr double kLate_s = 1.2e-3;
  auto set = set_of([](const Moment&) { return 0.0; });
  for (std::size_t k = 0; k < set.trials.size(); ++k)
    for (std::size_t i = 0; i < set.trials[k].t_s.size(); ++i) {
      const Moment now = moment(int(k), set.trials[k].t_s[i]),
                   then = moment(int(k), set.trials[k].t_s[i] - kLate_s);
      set.trials[k].fz_N[i] +=
          kStiffness * (then.x_m - now.x_m) + kDamping * (then.v_m_s - now.v_m_s);
    }
  const auto problem = made(std::move(set));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::complete);
  EXPECT_LT(d->base.held_out_rmse, 1.05 * kNoise_N);
  const auto& all = d->base_fit.estimates;
  const auto late = std::ranges::find(all, "/sensor/force_delay_s", &Estimate::pointer);
  ASSERT_NE(late, all.end());
  EXPECT_NEAR(late->value, kLate_s, 5e-5);
}

TEST(ProbingProblem, NoiseThatIsColouredIsInTheFloor) {
  // An autoregressive process of order 1: variance s²/(1 − a²) of steps s, correlated over 1/(1 − a) = 5 samples.
  std::mt19937_64 random(31);
  std::normal_distribution<> normal;
  auto set = set_of([](const Moment&) { return 0.0; });
  const double step_N = 0.06, total_N = std::hypot(kNoise_N, step_N / std::sqrt(1.0 - 0.64));
  for (auto& trial : set.trials) {
    double level = 0.0;
    for (double& f : trial.fz_N) f += level = 0.8 * level + step_N * normal(random);
  }
  const auto problem = made(std::move(set));
  EXPECT_NEAR(problem->channels().front().noise_floor, total_N, 0.25 * total_N);  // alone: 0.05
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::complete);
}

TEST(ProbingProblem, TheFloorHoldsNoiseThatIsCorrelatedOverManySamples) {
  // An autoregressive process of order 1 that forgets within 3.8 ms, at 2 kHz: variance s²/(1 − a²).
  std::mt19937_64 random(37);
  std::normal_distribution<> normal;
  auto set = set_of([](const Moment&) { return 0.0; }, 6, 2000.0);
  const double a = std::exp(-0.5e-3 / 3.8e-3), level_N = 0.3,
               step_N = level_N * std::sqrt(1.0 - a * a);
  for (auto& trial : set.trials) {
    double level = 0.0;
    for (double& f : trial.fz_N) f += level = a * level + step_N * normal(random);
  }
  const auto problem = made(std::move(set));
  const double total_N = std::hypot(kNoise_N, level_N);
  EXPECT_NEAR(problem->channels().front().noise_floor, total_N, 0.14 * total_N);
}

TEST(ProbingProblem, AModelThatIsRightIsAtTheFloorAndItsNumbersAreFound) {
  const auto problem = made(set_of([](const Moment&) { return 0.0; }));
  const auto f = fit(*problem, {});
  ASSERT_TRUE(f) << f.error().what;
  for (const Estimate& e : f->estimates) {
    if (e.pointer.ends_with("stiffness_N_per_m")) {
      EXPECT_NEAR(e.value, kStiffness, 3.0);
    }
    if (e.pointer.ends_with("damping_Ns_per_m")) {
      EXPECT_NEAR(e.value, kDamping, 2.0);
    }
  }
  EXPECT_NEAR(f->rmse, kNoise_N, 0.1 * kNoise_N);
  EXPECT_NEAR(f->noise_floor, kNoise_N, 0.15 * kNoise_N);
  EXPECT_LT(f->held_out_rmse, 1.1 * kNoise_N);
}

/// A filter of 100 outputs a second needs 22 ms on either side.
TEST(ProbingProblem, TheEndsOfARecordingAreNotJudged) {
  const auto problem = made(set_of([](const Moment&) { return 0.0; }, 4, 1000.0));
  std::vector<double> values;
  for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
  const auto judged = problem->full_rate({}, values, 0).judgement;
  ASSERT_EQ(judged.size(), 6000u);
  for (std::size_t k = 0; k < 22; ++k) {
    EXPECT_EQ(judged[k], Judgement::unknown_motion) << k;
    EXPECT_EQ(judged[5999 - k], Judgement::unknown_motion) << k;
  }
  EXPECT_EQ(judged[22], Judgement::judged);
  EXPECT_EQ(judged[5977], Judgement::judged);
}

/// Cut off at 0.7 of the largest force, where the sensor was zeroed before each trial, the right model still lacks nothing, and
/// its numbers are found.
TEST(ProbingProblem, ASensorAtTheEndOfItsRangeIsNotJudged) {
  auto set = set_of([](const Moment&) { return 0.0; });
  double most_N = 0.0;
  for (const auto& trial : set.trials) most_N = std::max(most_N, std::ranges::max(trial.fz_N));
  double limit_N = 0.7 * most_N;
  for (auto& trial : set.trials) {
    for (double& force_N : trial.fz_N) force_N = std::min(force_N, limit_N);
    limit_N *= 1.01;
  }
  const auto problem = made(std::move(set));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::complete);
  EXPECT_NEAR(d->final_fit.rmse, kNoise_N, 0.2 * kNoise_N);
  for (const Estimate& e : d->final_fit.estimates) {
    if (e.pointer.ends_with("stiffness_N_per_m")) {
      EXPECT_NEAR(e.value, kStiffness, 0.01 * kStiffness);
    }
  }
  std::vector<double> values;
  for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
  EXPECT_GT(std::ranges::count(problem->full_rate({}, values, 0).judgement, Judgement::saturated),
            50);
}

/// Jolted once, 3 s after the start: a probe with mass is not judged there, one without is.
TEST(ProbingProblem, AHeavyProbeIsNotJudgedWhereItsAccelerationIsNotKnown) {
  constexpr double kLittle = 5.0;  // N·s/m: what is not known of the speed makes no force
  const auto at_the_jolt = [](double mass_kg) {
    trial::ProbingSet set =
        set_of([](const Moment& m) { return (kLittle - kDamping) * m.v_m_s; }, 4, 1000.0);
    for (std::size_t k = 0; k < set.trials.size(); ++k)
      for (std::size_t i = 0; i < set.trials[k].t_s.size(); ++i) {
        const double t_s = set.trials[k].t_s[i], u = (t_s - 3.0) / 0.004, h_s = 1e-4;
        const auto speed = [&](double at_s) { return moment(int(k), at_s).v_m_s; };
        set.trials[k].x_m[i] += 1e-4 * std::exp(-u * u);
        set.trials[k].fz_N[i] += mass_kg * ((speed(t_s + h_s) - speed(t_s - h_s)) / (2.0 * h_s) +
                                            1e-4 * (4.0 * u * u - 2.0) / 1.6e-5 * std::exp(-u * u));
      }
    models::ProbingModel model = model_of(kStiffness, kLittle);
    model.effects = {{"inertia", {mass_kg}}};
    const auto problem = made(std::move(set), model);
    std::vector<double> values;
    for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
    return problem->full_rate({}, values, 0).judgement[3000];
  };
  EXPECT_EQ(at_the_jolt(1e-5), Judgement::judged);
  EXPECT_EQ(at_the_jolt(0.2), Judgement::unknown_motion);
}

/// At 4 kHz a fit predicts for one sample of five; the whole recording is judged.
TEST(ProbingProblem, AFastRecordingIsFittedByFewerSamplesAndJudgedByAll) {
  const auto problem =
      made(set_of([](const Moment& m) { return 1.5 * (m.v_m_s > 0 ? 1.0 : -1.0); }, 4, 4000.0));
  const auto f = fit(*problem, {{"coulomb_friction"}});
  ASSERT_TRUE(f) << f.error().what;
  for (const Estimate& e : f->estimates) {
    if (e.pointer == "coulomb_friction/friction_N") {
      EXPECT_NEAR(e.value, 1.5, 0.01);
    }
    if (e.pointer.ends_with("stiffness_N_per_m")) {
      EXPECT_NEAR(e.value, kStiffness, 3.0);
    }
  }
  EXPECT_NEAR(f->rmse, kNoise_N, 0.1 * kNoise_N);
  EXPECT_EQ(problem->full_rate({}, std::vector<double>(problem->parameters({}).size(), 1.0), 0)
                .t_s.size(),
            24000u);
}

TEST(ProbingProblem, HiddenFrictionIsNamedFromAModelThatIsOffByAFifth) {
  const auto problem =
      made(set_of([](const Moment& m) { return 1.5 * (m.v_m_s > 0 ? 1.0 : -1.0); }));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::missing);
  ASSERT_EQ(d->effects.size(), 1u);
  EXPECT_EQ(d->effects[0].id, "coulomb_friction");
  EXPECT_NEAR(d->effects[0].parameters[0].value[0], 1.5, 0.03);
}

constexpr double kTurnViscous_Nms_per_rad = 0.01, kTurnNoise_Nm = 2e-4;

/// SIMULATED: a stage that turns and does not slide, with a hidden spring. Trials are `more` samples longer one by one.
std::unique_ptr<Problem> turns_only(double rate_Hz, int samples, int more,
                                    double stiffness_Nm_per_rad) {
  std::mt19937_64 random(9);
  std::normal_distribution<> normal;
  trial::ProbingSet set;
  set.folder = "turns";
  for (int k = 0; k < 6; ++k) {
    trial::ProbingMeasurement m;
    m.id = "t" + std::to_string(k);
    m.file = m.id + ".csv";
    const double a = 1.5 + 0.2 * k, b = 2.3 * a;
    for (int i = 0; i < samples + more * k; ++i) {
      const double t = i / rate_Hz, theta = 0.8 * std::sin(a * t) + 0.2 * std::sin(b * t + k),
                   omega = 0.8 * a * std::cos(a * t) + 0.2 * b * std::cos(b * t + k);
      m.t_s.push_back(t);
      m.theta_rad.push_back(theta + 1e-5 * normal(random));
      m.tz_Nm.push_back(kTurnViscous_Nms_per_rad * omega + stiffness_Nm_per_rad * theta +
                        kTurnNoise_Nm * normal(random));
    }
    set.trials.push_back(std::move(m));
  }
  models::ProbingModel model;
  model.name = "turns";
  model.rotary = {.viscous_Nms_per_rad = 0.012, .detent_Nm = 0.0, .detent_pitch_rad = 0.26};
  return made(std::move(set), model);
}

TEST(ProbingProblem, ARigThatOnlyTurnsNamesAHiddenStiffness) {
  constexpr double kStiffness_Nm_per_rad = 0.02;
  const auto d = diagnose(*turns_only(500.0, 3000, 0, kStiffness_Nm_per_rad));
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::missing);
  ASSERT_EQ(d->effects.size(), 1u);
  EXPECT_EQ(d->effects[0].id, "rotary_stiffness");
  EXPECT_NEAR(d->effects[0].parameters[0].value[0] / kStiffness_Nm_per_rad, 1.0, 0.01);
  EXPECT_NEAR(d->final_fit.noise_floor / kTurnNoise_Nm, 1.0, 0.1);
}

/// Fitted by fewer samples (as the test before the last), whatever remainder the length leaves.
TEST(ProbingProblem, AFastRecordingOfTurnsMayHaveAnyLength) {
  const auto problem = turns_only(4000.0, 8000, 7, 0.0);
  ASSERT_TRUE(problem);
  const auto f = fit(*problem, {});
  ASSERT_TRUE(f) << f.error().what;
  EXPECT_NEAR(f->estimates.at(0).value / kTurnViscous_Nms_per_rad, 1.0, 0.01);
  EXPECT_NEAR(f->rmse / kTurnNoise_Nm, 1.0, 0.1);
}

/// Sliding and turning at once. The torque is that of [Probing]'s turning stage without a detent; a hidden spring is added.
trial::ProbingSet turning_set(double stiffness_Nm_per_rad) {
  constexpr double kViscous_Nms_per_rad = 0.01, kNoise_Nm = 2e-4;
  std::mt19937_64 random(10);
  std::normal_distribution<> normal;
  trial::ProbingSet set = set_of([](const Moment&) { return 0.0; });
  for (std::size_t k = 0; k < set.trials.size(); ++k) {
    trial::ProbingMeasurement& m = set.trials[k];
    const double a = 1.5 + 0.2 * double(k), b = 2.3 * a;
    for (const double t : m.t_s) {
      const double theta = 0.8 * std::sin(a * t) + 0.2 * std::sin(b * t + double(k)),
                   omega = 0.8 * a * std::cos(a * t) + 0.2 * b * std::cos(b * t + double(k));
      m.theta_rad.push_back(theta + 1e-5 * normal(random));
      m.tz_Nm.push_back(kViscous_Nms_per_rad * omega + stiffness_Nm_per_rad * theta +
                        kNoise_Nm * normal(random));
    }
  }
  return set;
}

core::Result<Diagnosis> diagnosis_of_torque(double stiffness_Nm_per_rad) {
  models::ProbingModel model = model_of();
  model.rotary = {.viscous_Nms_per_rad = 0.012, .detent_Nm = 0.0, .detent_pitch_rad = 0.26};
  const auto problem = TRY(make_probing_problem(model, turning_set(stiffness_Nm_per_rad),
                                                {.threads = 2, .torque_beside_force = true}));
  EXPECT_EQ(problem->channels().front().name, "tz_Nm");
  return diagnose(*problem);
}

TEST(ProbingProblem, TheTorqueBesideAForceNamesAHiddenStiffness) {
  const auto d = diagnosis_of_torque(0.005);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::missing);
  ASSERT_EQ(d->effects.size(), 1u);
  EXPECT_EQ(d->effects[0].id, "rotary_stiffness");
  EXPECT_NEAR(d->effects[0].parameters[0].value[0] / 0.005, 1.0, 0.01);
  for (const Ranked& one : d->ranking)
    EXPECT_TRUE(one.id.find("rotary") != std::string::npos) << one.id << " acts on the force";
}

TEST(ProbingProblem, ATorqueThatLacksNothingIsComplete) {
  const auto d = diagnosis_of_torque(0.0);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::complete);
}

/// SIMULATED: a slow trend of each trial's own, as a sensor's: a constant and a parabola in time, N.
double own_trend_N(int trial, double t_s) {
  const double share = t_s / 3.0 - 1.0;
  return 0.4 * std::sin(2.0 + 3.0 * trial) + 0.5 * std::cos(5.0 * trial) * share * share;
}

trial::ProbingSet with_own_trends(trial::ProbingSet set) {
  for (std::size_t k = 0; k < set.trials.size(); ++k)
    for (std::size_t i = 0; i < set.trials[k].t_s.size(); ++i)
      set.trials[k].fz_N[i] += own_trend_N(int(k), set.trials[k].t_s[i]);
  return set;
}

std::vector<std::string> named(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const FoundEffect& effect : d.effects) out.push_back(effect.id);
  std::ranges::sort(out);
  return out;
}

TEST(ProbingProblem, ASmallFrictionIsNamedBesideADriftThatTakesMost) {
  const auto problem = made(with_own_trends(
      set_of([](const Moment& m) { return 0.03 * (m.v_m_s > 0 ? 1.0 : -1.0); }, 8)));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_THAT(named(*d), testing::ElementsAre("coulomb_friction", "sensor_drift"));
}

TEST(ProbingProblem, ATrendThatFollowsTheMotionIsNoDriftOfTheSensor) {
  // A spring that stiffens, which is in no catalogue, under a slow stroke with a quick tremor: 0.3 N of it are slow.
  const auto slow_stroke = [](int trial, double t) -> Moment {
    const double a = 0.5 + 0.04 * trial, b = 18.0;
    return {t, 0.012 + 0.004 * std::sin(a * t + trial) + 0.0002 * std::sin(b * t),
            0.004 * a * std::cos(a * t + trial) + 0.0002 * b * std::cos(b * t), 2.0};
  };
  const auto problem =
      made(set_of([](const Moment& m) { return 2e4 * (m.x_m - 0.012) * (m.x_m - 0.012); }, 8, 500.0,
                  slow_stroke));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_THAT(named(*d), testing::Not(testing::Contains("sensor_drift")));
  EXPECT_THAT(d->notes, testing::Contains(HasSubstr("sensor_drift was left out")));
}

TEST(ProbingProblem, ARecordingOfNoiseDoesNotSayThatNothingIsMissing) {
  // By set_of the force has 45.5 N in the root mean square; with noise of 12 N it is 47.0 N.
  std::mt19937_64 random(3);
  std::normal_distribution<> noise_N(0.0, 12.0);
  const auto problem = made(set_of([&](const Moment&) { return noise_N(random); }));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::undecided);
  EXPECT_NEAR(d->floor_share, 12.0 / 47.0, 0.02);
  EXPECT_TRUE(std::isnan(d->probability));
}

TEST(ProbingProblem, WhatNeedsAChannelThatWasNotRecordedIsLeftOutAndSaidSo) {
  const auto problem = made(set_of([](const Moment&) { return 0.0; }));
  for (const Candidate& c : problem->candidates()) {
    if (c.facts.id == "rotation_coupling") {
      EXPECT_FALSE(c.possible);
      EXPECT_THAT(c.why_not, HasSubstr("theta_rad"));
    }
    if (c.facts.id == "torque_crosstalk") {
      EXPECT_THAT(c.why_not, HasSubstr("tz_Nm"));
    }
  }
}

TEST(ProbingProblem, FixedNumbersAndLayersNeverEnteredStay) {
  models::ProbingModel model = model_of(3000.0, 1200.0);
  model.layers.push_back({0.04, 0.01, 8000.0, 900.0, 0.0});
  model.fixed = {"/base/layers/*/damping_Ns_per_m"};
  const auto problem = made(set_of([](const Moment&) { return 0.0; }), model);
  for (const Parameter& p : problem->parameters({})) {
    EXPECT_EQ(p.pointer.find("damping"), std::string::npos);
    EXPECT_EQ(p.pointer.find("layers/1"), std::string::npos);
  }
  ASSERT_FALSE(problem->notes().empty());
  EXPECT_THAT(problem->notes()[0], HasSubstr("layer 1"));
}

TEST(ProbingProblem, NoBorderPassesAnotherWhereverAFitMovesThem) {
  auto model = model_of();
  model.layers = {{0.0, 0.006, 3000.0, 1000.0, 0.0},
                  {0.006, 0.004, 3000.0, 1000.0, 0.0},
                  {0.010, 0.004, 3000.0, 1000.0, 0.0},
                  {0.014, 0.02, 3000.0, 1000.0, 0.0}};
  const auto problem = made(set_of([](const Moment&) { return 0.0; }), model);
  ASSERT_TRUE(problem);
  const auto all = problem->parameters({});
  for (unsigned corner = 0; corner < 8; ++corner) {  // each of three borders at either end
    std::vector<double> values;
    unsigned border = 0;
    for (const Parameter& p : all)
      values.push_back(!p.pointer.ends_with("start_m") ? p.start
                       : corner >> border++ & 1u       ? p.high
                                                       : p.low);
    ASSERT_EQ(border, 3u);
    const auto layers = problem->model({}, values).at("base").at("layers");
    for (std::size_t k = 0; k < layers.size(); ++k)
      EXPECT_GT(layers[k].at("thickness_m").get<double>(), 0.0) << corner;
  }
}

TEST(ProbingProblem, RefusesRecordingsThatTellNothing) {
  const auto still = [] {
    auto set = set_of([](const Moment&) { return 0.0; }, 1);
    for (double& x : set.trials[0].x_m) x = 0.01;
    return set;
  };
  EXPECT_THAT(make_probing_problem(model_of(), still()).error().what, HasSubstr("moves by"));
  auto few = set_of([](const Moment&) { return 0.0; }, 1);
  for (auto* all : {&few.trials[0].t_s, &few.trials[0].x_m, &few.trials[0].fz_N}) all->resize(20);
  EXPECT_THAT(make_probing_problem(model_of(), std::move(few)).error().what,
              HasSubstr("t0.csv: 20 samples"));
  EXPECT_THAT(make_probing_problem(model_of(), set_of([](const Moment&) { return 0.0; }, 1, 20.0))
                  .error()
                  .what,
              HasSubstr("samples per second"));
}

TEST(ProbingProblem, TheExtendedModelHoldsTheEffectWithItsNumbers) {
  const auto problem =
      made(set_of([](const Moment& m) { return 40'000.0 * m.v_m_s * std::abs(m.v_m_s); }));
  const auto d = diagnose(*problem);
  ASSERT_TRUE(d) << d.error().what;
  const core::Json json = problem->model(d->final_fit.structure, d->final_fit.values);
  const auto back = models::ProbingModel::from_json(json, "extended: ");
  ASSERT_TRUE(back) << back.error().what;
  ASSERT_EQ(back->effects.size(), 1u);
  EXPECT_EQ(back->effects[0].id, "quadratic_drag");
  EXPECT_NEAR(back->effects[0].values[0], 40'000.0, 400.0);
}

TEST(ProbingProblem, AModelWithoutLayersIsFittedByEffectsAlone) {
  auto set = set_of([](const Moment& m) {
    return 1.5 * (m.v_m_s > 0 ? 1.0 : -1.0) - kStiffness * m.x_m - kDamping * m.v_m_s;
  });
  models::ProbingModel empty;
  empty.name = "air";
  const auto d = diagnose(*made(std::move(set), empty));
  ASSERT_TRUE(d) << d.error().what;
  ASSERT_EQ(d->effects.size(), 1u);
  EXPECT_EQ(d->effects[0].id, "coulomb_friction");
}

}  // namespace
}  // namespace lab
}  // namespace tractus
