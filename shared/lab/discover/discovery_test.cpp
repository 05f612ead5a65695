#include "lab/discover/discovery.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "effects/expression.hpp"
#include "lab/discover/table_effect.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/rigs/probing/problem.hpp"
#include "models/probing_runtime.hpp"

namespace tractus {
namespace lab {
namespace {

using testing::HasSubstr;

/// What is hidden, N: of depth, speed and time since the last sample; called once a sample in order.
using HiddenForce = std::function<double(double x_m, double v_m_s, double bone_N, bool first)>;

/// Six trials of 6 s at 500 Hz in one layer, 4000 N/m and 2000 N·s/m about 6 mm, with noise of
/// 0.03 N and a hidden force; written down here.
trial::ProbingSet recorded_with(const HiddenForce& hidden) {
  trial::ProbingSet set;
  set.folder = "set";
  for (int k = 0; k < 6; ++k) {
    trial::ProbingMeasurement t;
    t.id = t.file = std::string("t") + char('1' + k);
    for (int i = 0; i < 3000; ++i) {
      const double s = 0.002 * i, w = 1.1 + 0.3 * k;
      const double x = 0.010 + 0.007 * std::sin(w * s) + 0.002 * std::sin(5.3 * s + k);
      const double v = 0.007 * w * std::cos(w * s) + 0.0106 * std::cos(5.3 * s + k);
      const double bone = 4000.0 * (x - 0.006) + 2000.0 * v;
      const double noise = std::sin(7919.0 * i * (i + 1.0 + k));
      t.t_s.push_back(s);
      t.x_m.push_back(x + 1e-7 * noise);
      t.fz_N.push_back(bone + hidden(x, v, bone, i == 0) + 0.04 * noise);
    }
    set.trials.push_back(std::move(t));
  }
  return set;
}

struct FoundFormulas {
  std::unique_ptr<Problem> problem;
  Diagnosis diagnosis;
  Discovery discovery;
};

/// The search on top of the base alone, as if the catalogue had found nothing.
FoundFormulas found_in(const HiddenForce& hidden) {
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 3800.0, 2100.0, 0.006}};
  auto problem = make_probing_problem(model, recorded_with(hidden), {.threads = 2});
  EXPECT_TRUE(problem) << problem.error().what;
  FoundFormulas out{std::move(*problem), {}, {}};
  const auto base = fit(*out.problem, {}, {.threads = 2});
  EXPECT_TRUE(base) << base.error().what;
  out.diagnosis.verdict = Verdict::unexplained;
  out.diagnosis.base_fit = out.diagnosis.final_fit = *base;
  out.diagnosis.base = {base->rmse, base->held_out_rmse, base->noise_floor};
  const auto discovery = discover(*out.problem, out.diagnosis, {.threads = 2, .most = 3});
  EXPECT_TRUE(discovery) << discovery.error().what;
  out.discovery = *discovery;
  return out;
}

double sign_of(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }

TEST(Discovery, WritesDownFrictionInProportionToTheLoad) {
  const FoundFormulas found = found_in(
      [](double, double v, double bone, bool) { return 0.2 * std::abs(bone) * sign_of(v); });
  ASSERT_FALSE(found.discovery.proposals.empty()) << found.discovery.remark;
  const Proposal& best = found.discovery.proposals.front();
  EXPECT_EQ(formula_text(best), "amplitude * abs(base_N) * sgn(v_m_s)");
  const ProposedNumber& share = best.terms[0].numbers[0];
  EXPECT_NEAR(share.value, 0.2, 0.004);
  EXPECT_TRUE(share.low < share.value && share.value < share.high);
  EXPECT_GT(best.probability, 0.5);
  EXPECT_LT(best.held_out_rmse, 2.0 * found.discovery.noise_floor);
  EXPECT_EQ(best.trials_improved, 6);
  EXPECT_TRUE(best.passive);
  EXPECT_THAT(sentences(found.discovery, "N"), HasSubstr("in proportion to the load (Amontons)"));
  // What is proposed is a user effect as it stands.
  const auto effect =
      effects::Expression::from_json(best.terms[0].effect, "", effects::probing_expressions());
  ASSERT_TRUE(effect) << effect.error().what;
  EXPECT_EQ(effect->facts().id, "expression:proposal_1");
}

TEST(Discovery, FindsTheNumbersOfHysteresisThatHardens) {
  // dz = dx − (|dx| z + g dx |z|)/δ, δ = 1.5 mm, g = −1.2; 1500 N/m; Euler's rule at 200 steps a sample.
  double z = 0.0, before = 0.0;
  const FoundFormulas found = found_in([&](double x, double, double, bool first) {
    if (first) z = 0.0, before = x;
    const double dx = (x - before) / 200.0;
    for (int k = 0; k < 200; ++k) z += dx - (std::abs(dx) * z - 1.2 * dx * std::abs(z)) / 1.5e-3;
    before = x;
    return 1500.0 * z;
  });
  ASSERT_FALSE(found.discovery.proposals.empty()) << found.discovery.remark;
  const Proposal& best = found.discovery.proposals.front();
  EXPECT_EQ(formula_text(best), "amplitude * bouc_wen(x_m, yield_m, g)");
  EXPECT_NEAR(best.terms[0].numbers[0].value, 1500.0, 30.0);
  EXPECT_NEAR(best.terms[0].numbers[1].value, 1.5e-3, 3e-5);
  EXPECT_NEAR(best.terms[0].numbers[2].value, -1.2, 0.024);
}

TEST(Discovery, SaysThatAFunctionIsUnknownWhereNoFormulaIsIt) {
  // A rough surface: a force of the depth alone, by no formula of the grammar.
  const FoundFormulas found = found_in([](double x, double, double, bool) {
    double out = 0.0;
    for (const double k : {700.0, 1130.0, 1570.0, 1990.0, 2470.0})
      out += 0.8 * std::sin(k * x + std::cos(3.0 * k));
    return out;
  });
  const Discovery& d = found.discovery;
  EXPECT_GT(d.unknown_probability, 0.5);
  ASSERT_TRUE(d.unknown);
  EXPECT_EQ(d.unknown->signals.front(), "x_m");
  for (const Proposal& proposal : d.proposals) EXPECT_LE(proposal.probability, 0.5);
  // Added as a table, it takes the error down to what such a table leaves.
  if (d.unknown->signals.size() == 1) {
    const auto table = table_effect(*d.unknown, "expression:unknown_function");
    ASSERT_TRUE(table);
    EXPECT_THAT((*table)["summary"].get<std::string>(), HasSubstr("a table of"));
  }
  EXPECT_THAT(sentences(d, "N"), HasSubstr("an unknown function of x_m"));
}

TEST(TableEffect, IsStraightBetweenItsKnotsAndConstantBeyond) {
  UnknownFunction function;
  function.signals = {"x_m"};
  function.units = {"m"};
  function.knots = {{0.001, 0.004, 0.010}};
  function.force_N = {2.0, -1.0, 0.5};
  const auto table = table_effect(function, "expression:unknown_function");
  ASSERT_TRUE(table);
  const auto effect = effects::Expression::from_json(*table, "", effects::probing_expressions());
  ASSERT_TRUE(effect) << effect.error().what;
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 1e-9, 1e-9, 0.0}};  // next to nothing beside it
  model.effects = {effect->use()};
  const auto runtime = models::ProbingRuntime::make(model, 0.05);
  ASSERT_TRUE(runtime) << runtime.error().what;
  const effects::ProbingMotion motion{.t_s = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5},
                                      .x_m = {0.0, 0.001, 0.0025, 0.004, 0.007, 0.020},
                                      .v_m_s = std::vector<double>(6, 0.0),
                                      .a_m_s2 = std::vector<double>(6, 0.0)};
  models::ProbingForces forces;
  runtime->predict(motion, forces);
  const double expected_N[] = {2.0, 2.0, 0.5, -1.0, -0.25, 0.5};  // straight lines by hand
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(forces.fz_N[std::size_t(k)], expected_N[k], 1e-4) << k;
}

TEST(TableEffect, OfTwoSignalsThereIsNone) {
  UnknownFunction function;
  function.signals = {"x_m", "v_m_s"};
  function.units = {"m", "m/s"};
  function.knots = {{0.0, 1.0}, {0.0, 1.0}};
  function.force_N = {0.0, 1.0, 2.0, 3.0};
  EXPECT_FALSE(table_effect(function, "expression:unknown_function"));
}

TEST(Discovery, ProposesNothingForAModelThatIsComplete) {
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.006}};
  const auto problem = make_probing_problem(
      model, recorded_with([](double, double, double, bool) { return 0.0; }), {.threads = 2});
  ASSERT_TRUE(problem) << problem.error().what;
  const auto found = discover(**problem, Diagnosis{}, {});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->proposals.empty());
  EXPECT_THAT(sentences(*found, "N"), HasSubstr("nothing is missing"));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
