/// What every effect of the probing rig keeps to, whatever it is; over the whole catalogue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/expression.hpp"
#include "models/probing_runtime.hpp"
#include "station/loop/allocation_guard.hpp"

namespace tractus {
namespace {

using effects::Kind;
using effects::Param;
using effects::ProbingEffectInfo;
using models::ProbingForces;
using models::ProbingLive;
using models::ProbingModel;
using models::ProbingMotion;
using models::ProbingRuntime;

constexpr double kTravel_m = 0.05;
constexpr double kTurning_rad_s = 1.0;

const ProbingEffectInfo& entry(const std::string& id) {
  return *std::ranges::find(effects::probing_effects(), id,
                            [](const auto& info) { return info.facts.id; });
}

enum class At { off, initial, low, high };

/// The effect with all its numbers at one place of their ranges; off, those of shape stay initial.
effects::EffectInstance use_of(const ProbingEffectInfo& info, At at) {
  effects::EffectInstance use{info.facts.id, {}};
  for (const Param& p : info.facts.params) {
    double value = p.initial;
    if (at == At::low) value = p.low;
    if (at == At::high) value = p.high;
    if (at == At::off && !std::isnan(p.off)) value = p.off;
    use.values.insert(use.values.end(), std::size_t(p.components), value);
  }
  return use;
}

/// One layer over the whole travel: K = 4000 N/m, D = 2000 N·s/m, spring at rest at depth 0.
ProbingModel bone() {
  ProbingModel model;
  model.layers = {{0.0, kTravel_m, 4000.0, 2000.0, 0.0}};
  return model;
}

ProbingRuntime runtime_of(ProbingModel model, std::vector<effects::EffectInstance> uses) {
  model.effects = std::move(uses);
  auto runtime = ProbingRuntime::make(model, kTravel_m);
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

/// x = 10 mm − 8 mm cos(2π t / 2 s): in and out, with turning that is faster on the way in.
ProbingMotion cycles(double rate_Hz, double length_s) {
  ProbingMotion m{.rest_m_s = 0.0};
  const double w = std::numbers::pi, a_m = 0.008;
  const auto n = std::size_t(std::lround(rate_Hz * length_s)) + 1;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = double(k) / rate_Hz;
    m.t_s.push_back(t);
    m.x_m.push_back(0.010 - a_m * std::cos(w * t));
    m.v_m_s.push_back(a_m * w * std::sin(w * t));
    m.a_m_s2.push_back(a_m * w * w * std::cos(w * t));
    m.omega_rad_s.push_back(2.0 + std::sin(w * t));
    m.theta_rad.push_back(2.0 * t - std::cos(w * t) / w);
    m.tz_Nm.push_back(0.05 + 0.02 * std::sin(3.0 * t));
  }
  return m;
}

/// The same way, in more slowly than out, so that drag that differs with the direction shows.
ProbingMotion skewed_cycles(double rate_Hz, double length_s) {
  ProbingMotion m = cycles(rate_Hz, length_s);
  const double w = std::numbers::pi, a_m = 0.008, skew = 0.4;
  for (std::size_t k = 0; k < m.size(); ++k) {
    const double turned = w * m.t_s[k];
    const double phase = turned + skew * (std::cos(turned) - 1.0);
    const double rate = w * (1.0 - skew * std::sin(turned));
    const double bend = -w * w * skew * std::cos(turned);
    m.x_m[k] = 0.010 - a_m * std::cos(phase);
    m.v_m_s[k] = a_m * rate * std::sin(phase);
    m.a_m_s2[k] = a_m * (rate * rate * std::cos(phase) + bend * std::sin(phase));
  }
  return m;
}

std::vector<double> predicted(const ProbingRuntime& runtime, const ProbingMotion& motion) {
  ProbingForces forces;
  runtime.predict(motion, forces);
  return forces.fz_N;
}

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

/// A push that goes in and out, N: enough to break every friction of the initial numbers loose.
double push_N(double t_s) { return 40.0 + 30.0 * std::sin(4.0 * t_s); }

/// The live motion under that push from depth 5 mm; the push of each tick is in `push`.
struct Course {
  ProbingMotion motion{.rest_m_s = 0.0};
  std::vector<double> push_N;
};
Course live(const ProbingRuntime& runtime, double dt_s, double length_s) {
  ProbingLive state{.at = {.x_m = 0.005}};
  Course course;
  double before_m_s = 0.0;
  for (int k = 0; k < int(std::lround(length_s / dt_s)); ++k) {
    const double push = push_N(double(k) * dt_s);
    const double v = runtime.advance(push, kTurning_rad_s, dt_s, state);
    course.push_N.push_back(push);
    course.motion.t_s.push_back(state.t_s);
    course.motion.x_m.push_back(state.at.x_m);
    course.motion.v_m_s.push_back(v);
    course.motion.a_m_s2.push_back((v - before_m_s) / dt_s);
    course.motion.theta_rad.push_back(state.theta_rad);
    course.motion.omega_rad_s.push_back(kTurning_rad_s);
    before_m_s = v;
  }
  return course;
}

class EveryEffect : public testing::TestWithParam<std::string> {
 protected:
  const ProbingEffectInfo& info_ = entry(GetParam());
  bool measures() const { return info_.facts.kind == Kind::measurement; }
};

/// Those that reach a hand.
class EveryRenderedEffect : public EveryEffect {};

/// Those about the axis too, whose laws every_rotary_effect_test.cpp keeps.
class EveryEntry : public testing::TestWithParam<std::string> {};

TEST_P(EveryEntry, SaysWhatItIs) {
  const auto& f = entry(GetParam()).facts;
  EXPECT_FALSE(f.summary.empty() || f.equation.empty() || f.source.empty());
  EXPECT_FALSE(f.params.empty());
  EXPECT_TRUE(std::ranges::any_of(f.params, [](const Param& p) { return !std::isnan(p.off); }));
  for (const Param& p : f.params) {
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    EXPECT_TRUE(p.low < p.high && p.low <= p.initial && p.initial <= p.high) << p.name;
    EXPECT_TRUE(std::isnan(p.off) || (p.off >= p.low && p.off <= p.high)) << p.name;
    EXPECT_TRUE(!p.logarithmic || p.low > 0.0) << p.name;
  }
  for (const std::string& parent : f.parents) EXPECT_EQ(entry(parent).facts.id, parent);
}

TEST_P(EveryEffect, IsNothingWhenOff) {
  const auto motion = cycles(1000.0, 4.0);
  const auto base = predicted(runtime_of(bone(), {}), motion);
  EXPECT_LT(
      greatest_difference(base, predicted(runtime_of(bone(), {use_of(info_, At::off)}), motion)),
      1e-12);
}

TEST_P(EveryEffect, IsSomethingAtItsInitialNumbers) {
  const auto motion = cycles(1000.0, 4.0);
  const auto base = predicted(runtime_of(bone(), {}), motion);
  EXPECT_GT(greatest_difference(
                base, predicted(runtime_of(bone(), {use_of(info_, At::initial)}), motion)),
            0.05);  // the sensor's noise
}

TEST_P(EveryEffect, IsFiniteAndBoundedOverItsWholeRange) {
  const auto motion = cycles(500.0, 4.0);
  for (const At at : {At::initial, At::low, At::high}) {
    const auto runtime = runtime_of(bone(), {use_of(info_, at)});
    for (const double force_N : predicted(runtime, motion))
      ASSERT_LT(std::abs(force_N), 1e6) << int(at);  // NaN fails too
    for (const double x_m : live(runtime, 1e-3, 2.0).motion.x_m)
      ASSERT_TRUE(x_m >= 0.0 && x_m <= kTravel_m) << x_m;
  }
}

TEST_P(EveryEffect, AllocatesNothingInATick) {
  for (const At at : {At::initial, At::low, At::high}) {
    const auto runtime = runtime_of(bone(), {use_of(info_, at)});
    ProbingLive state{.at = {.x_m = 0.005}};
    const loop::AllocationGuard guard;
    for (int k = 0; k < 1000; ++k)
      runtime.advance(push_N(double(k) * 1e-3), kTurning_rad_s, 1e-3, state);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST_P(EveryEffect, GivesTheSameBitsAgain) {
  const auto motion = cycles(1000.0, 4.0);
  const auto runtime = runtime_of(bone(), {use_of(info_, At::initial)});
  const auto first = predicted(runtime, motion);
  EXPECT_EQ(predicted(runtime, motion), first);
  EXPECT_EQ(predicted(runtime_of(bone(), {use_of(info_, At::initial)}), motion), first);
  EXPECT_EQ(live(runtime, 1e-3, 2.0).motion.x_m, live(runtime, 1e-3, 2.0).motion.x_m);
}

TEST_P(EveryEffect, IsFeltLiveUnlessItBelongsToTheSensor) {
  const auto base = live(runtime_of(bone(), {}), 1e-3, 2.0).motion.x_m;
  const auto with = live(runtime_of(bone(), {use_of(info_, At::initial)}), 1e-3, 2.0).motion.x_m;
  if (measures())
    EXPECT_EQ(with, base);
  else
    EXPECT_GT(greatest_difference(with, base), 1e-6);  // m
}

/// Live and replay are one law: the recorded motion of a live run, replayed, gives back its push.
TEST_P(EveryRenderedEffect, GivesBackThePushOfALiveMotion) {
  const auto runtime = runtime_of(bone(), {use_of(info_, At::initial)});
  Course course = live(runtime, 1e-3, 3.0);
  // The live run starts at 5 mm before its first tick; the recording's first sample is that start.
  auto& m = course.motion;
  m.t_s.insert(m.t_s.begin(), 0.0), m.x_m.insert(m.x_m.begin(), 0.005);
  m.v_m_s.insert(m.v_m_s.begin(), 0.0), m.a_m_s2.insert(m.a_m_s2.begin(), 0.0);
  m.theta_rad.insert(m.theta_rad.begin(), 0.0);
  m.omega_rad_s.insert(m.omega_rad_s.begin(), kTurning_rad_s);
  const auto force_N = predicted(runtime, m);
  int moving = 0;
  for (std::size_t k = 0; k < course.push_N.size(); ++k) {
    if (m.v_m_s[k + 1] == 0.0) continue;  // held by friction: the push is anything below it
    ++moving;
    ASSERT_NEAR(force_N[k + 1], course.push_N[k], 1e-6) << "tick " << k;
  }
  EXPECT_GT(moving, 2000);
}

/// The integrator is of first order: half the step, about half the error or less.
TEST_P(EveryRenderedEffect, ConvergesWithTheStep) {
  const auto runtime = runtime_of(bone(), {use_of(info_, At::initial)});
  const auto depth_m = [&](double dt_s) { return live(runtime, dt_s, 1.2).motion.x_m.back(); };
  const double finest = depth_m(1.5625e-5);
  const double coarse = std::abs(depth_m(1e-3) - finest), fine = std::abs(depth_m(2.5e-4) - finest);
  EXPECT_LT(coarse, 2e-5);  // of some 10 mm
  EXPECT_LT(fine, 0.4 * coarse + 1e-8);
}

/// The work of the hand over one steady cycle, J, against the effect (and the bone's spring, whose
/// work over a cycle is nothing, where the effect acts on the bone).
double work_per_cycle_J(const ProbingEffectInfo& info, At at) {
  ProbingModel spring;
  const auto made = info.make(use_of(info, At::initial).values);
  const bool on_bone = std::holds_alternative<std::unique_ptr<effects::BoneDepth>>(made) ||
                       std::holds_alternative<std::unique_ptr<effects::BoneScale>>(made);
  if (on_bone) spring.layers = {{0.0, kTravel_m, 4000.0, 1e-9, 0.0}};
  const auto motion = skewed_cycles(4000.0, 6.0);
  const auto force_N = predicted(runtime_of(spring, {use_of(info, at)}), motion);
  double work_J = 0.0;
  for (std::size_t k = motion.size() - 8000; k < motion.size(); ++k)
    work_J += 0.5 * (force_N[k] + force_N[k - 1]) * (motion.x_m[k] - motion.x_m[k - 1]);
  return work_J;
}

TEST_P(EveryRenderedEffect, GivesBackNoMoreWorkThanItGotUnlessItSaysSo) {
  const double work_J = work_per_cycle_J(info_, At::initial);
  if (!info_.facts.passive) {
    EXPECT_LT(work_J, -1e-4) << "says that it is not passive, and is";
    return;
  }
  EXPECT_GT(work_J, -1e-8)
      << "it returns more than it takes, " << -work_J
      << " J a cycle: its sign may be wrong (a force that resists an advancing probe is positive); "
         "if it is meant to, state .passive = false";
  EXPECT_GT(work_per_cycle_J(info_, At::high), -1e-4);
}

/// A user's own formula keeps to what its kind of effect keeps to.
effects::EffectInstance users_own(const char* formula, const char* unit) {
  const auto own = effects::Expression::from_json(
      core::Json{
          {"format", "tractus-effect/1"},
          {"id", "expression:own"},
          {"rig", "probing"},
          {"adds_to", "fz_N"},
          {"formula", formula},
          {"parameters", {{"c", {{"unit", unit}, {"initial", 3}, {"low", 0}, {"high", 1e4}}}}}},
      "", effects::probing_expressions());
  EXPECT_TRUE(own) << own.error().what;
  return own->use();
}

TEST(AUsersOwnEffect, IsTheCataloguesWhereTheFormulaIs) {
  const auto motion = cycles(1000.0, 4.0);
  const auto same = [&](const char* formula, const char* unit, const char* id) {
    const auto own = runtime_of(bone(), {users_own(formula, unit)});
    const auto known = runtime_of(bone(), {{id, {3.0}}});
    EXPECT_LT(greatest_difference(predicted(own, motion), predicted(known, motion)), 1e-9) << id;
    EXPECT_LT(
        greatest_difference(live(own, 1e-3, 2.0).motion.x_m, live(known, 1e-3, 2.0).motion.x_m),
        1e-9)
        << id;
  };
  same("c * sgn(v_m_s)", "N", "coulomb_friction");
  same("c * x_m * sgn(v_m_s)", "N/m", "depth_friction");
  same("c * v_m_s * abs(v_m_s)", "N*s^2/m^2", "quadratic_drag");
  same("c * a_m_s2", "kg", "inertia");
  same("base_N / (1 + c * abs(omega_rad_s)) - base_N", "s", "rotation_coupling");
}

/// The same with a second number.
effects::EffectInstance users_own(const char* formula, const char* unit, const char* other_unit,
                                  double c, double d) {
  const auto number = [](const char* of, double initial) {
    return core::Json{{"unit", of}, {"initial", initial}, {"low", 0}, {"high", 1e7}};
  };
  const auto own = effects::Expression::from_json(
      core::Json{{"format", "tractus-effect/1"},
                 {"id", "expression:own"},
                 {"rig", "probing"},
                 {"adds_to", "fz_N"},
                 {"formula", formula},
                 {"parameters", {{"c", number(unit, c)}, {"d", number(other_unit, d)}}}},
      "", effects::probing_expressions());
  EXPECT_TRUE(own) << own.error().what;
  return own->use();
}

TEST(AUsersOwnEffect, ThatRemembersIsTheCataloguesWhereTheLawIs) {
  const auto motion = cycles(1000.0, 4.0);
  const auto same = [&](const effects::EffectInstance& formula,
                        const effects::EffectInstance& use) {
    const auto own = runtime_of(bone(), {formula}), known = runtime_of(bone(), {use});
    EXPECT_LT(greatest_difference(predicted(own, motion), predicted(known, motion)), 1e-9)
        << use.id;
    EXPECT_LT(
        greatest_difference(live(own, 1e-3, 2.0).motion.x_m, live(known, 1e-3, 2.0).motion.x_m),
        1e-9)
        << use.id;
  };
  same(users_own("c * dahl(x_m, d)", "N/m", "m", 1e4, 1e-4), {"hysteresis", {1e4, 1e-4}});
  same(users_own("c * (x_m - lag(x_m, d))", "N/m", "s", 500.0, 0.5),
       {"viscoelastic_relaxation", {500.0, 0.5}});
  same(users_own("c * (play(x_m, d) - x_m)", "N/m", "m", 4000.0, 3e-4), {"backlash", {3e-4, 0.0}});
}

TEST(AUsersOwnEffect, ThatRemembersGivesBackThePushOfALiveMotion) {
  for (const auto& [formula, unit, other, c, d] :
       {std::tuple{"c * lag(v_m_s, d)", "N*s/m", "s", 50.0, 0.1},
        {"c * bouc_wen(x_m, d, 0.3)", "N/m", "m", 1e4, 3e-4},
        {"c * since_reversal(x_m) * sgn(v_m_s) * exp(-since_reversal(x_m)/d)", "N/m", "m", 1e3,
         1e-2},
        {"-c * base_N * (1 - exp(-work(base_N, x_m)/d))", "1", "N*m", 0.2, 0.5},
        {"c * resonator(x_m, d, 0.05)", "kg", "Hz", 0.3, 12.0}}) {
    const auto runtime = runtime_of(bone(), {users_own(formula, unit, other, c, d)});
    Course course = live(runtime, 1e-3, 2.0);
    auto& m = course.motion;
    m.t_s.insert(m.t_s.begin(), 0.0), m.x_m.insert(m.x_m.begin(), 0.005);
    for (auto* all : {&m.v_m_s, &m.a_m_s2, &m.theta_rad}) all->insert(all->begin(), 0.0);
    m.omega_rad_s.insert(m.omega_rad_s.begin(), kTurning_rad_s);
    const auto force_N = predicted(runtime, m);
    int moving = 0;
    for (std::size_t k = 0; k < course.push_N.size(); ++k) {
      if (m.v_m_s[k + 1] == 0.0) continue;
      ++moving;
      ASSERT_NEAR(force_N[k + 1], course.push_N[k], 1e-6) << formula << ", tick " << k;
    }
    EXPECT_GT(moving, 1000) << formula;
  }
}

TEST(AUsersOwnEffect, AllocatesNothingInATick) {
  const auto runtime = runtime_of(
      bone(),
      {
          users_own(
              "x_m > 0 ? c * min(x_m, 2*x_m) * sgn(v_m_s)^3 * exp(-theta_rad^2) : 0*tz_Nm/x_m",
              "N/m"),
      });
  const auto remembers =
      runtime_of(bone(), {users_own("c * lag(play(bouc_wen(x_m, d, 0), d), 0.1*t_s) * "
                                    "since_stop(v_m_s)/(since_stop(v_m_s) + age(x_m, d))",
                                    "N/m", "m", 300.0, 1e-3)});
  for (const auto* one : {&runtime, &remembers}) {
    ProbingLive state{.at = {.x_m = 0.005}};
    const loop::AllocationGuard guard;
    for (int k = 0; k < 1000; ++k)
      one->advance(push_N(double(k) * 1e-3), kTurning_rad_s, 1e-3, state);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

std::vector<std::string> all_ids() {
  std::vector<std::string> out;
  for (const auto& info : effects::probing_effects()) out.push_back(info.facts.id);
  return out;
}
std::vector<std::string> ids() {
  auto out = all_ids();
  std::erase_if(out,
                [](const auto& id) { return entry(id).facts.channel == effects::Channel::torque; });
  return out;
}
std::vector<std::string> rendered_ids() {
  auto out = ids();
  std::erase_if(out, [](const auto& id) { return entry(id).facts.kind == Kind::measurement; });
  return out;
}
const auto kName = [](const auto& one) { return one.param; };
INSTANTIATE_TEST_SUITE_P(Probing, EveryEntry, testing::ValuesIn(all_ids()), kName);
INSTANTIATE_TEST_SUITE_P(Probing, EveryEffect, testing::ValuesIn(ids()), kName);
INSTANTIATE_TEST_SUITE_P(Probing, EveryRenderedEffect, testing::ValuesIn(rendered_ids()), kName);

TEST(TheCatalogue, HoldsTheFourteenEffectsOfTheDesign) {
  EXPECT_THAT(ids(), testing::IsSupersetOf({"inertia", "coulomb_friction", "stribeck_friction",
                                            "quadratic_drag", "viscoelastic_relaxation",
                                            "hysteresis", "backlash", "depth_friction",
                                            "rotation_coupling", "force_ripple", "sensor_bias",
                                            "sensor_drift", "time_delay", "torque_crosstalk"}));
}

}  // namespace
}  // namespace tractus
