#include "lab/identify/user_effect_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "effects/expression.hpp"
#include "lab/rigs/probing/problem.hpp"

namespace tractus {
namespace lab {
namespace {

using ::testing::HasSubstr;

/// Strokes in one layer with 2 N of dry friction, written down here; quiet, so that nothing else
/// is in it.
trial::ProbingSet strokes() {
  trial::ProbingSet set;
  set.folder = "set";
  for (int k = 0; k < 2; ++k) {
    trial::ProbingMeasurement t;
    t.id = t.file = std::string("t") + char('1' + k);
    for (int i = 0; i < 3000; ++i) {
      const double s = 0.002 * i, w = 1.3 + 0.4 * k;
      const double x = 0.010 + 0.006 * std::sin(w * s) + 0.002 * std::cos(3.1 * s);
      const double v = 0.006 * w * std::cos(w * s) - 0.0062 * std::sin(3.1 * s);
      const double noise = std::sin(7919.0 * i * (i + 1.0 + k));
      t.t_s.push_back(s);
      t.x_m.push_back(x + 1e-7 * noise);
      t.fz_N.push_back(4000.0 * x + 2000.0 * v + (v > 0 ? 2.0 : -2.0) + 0.03 * noise);
    }
    set.trials.push_back(std::move(t));
  }
  return set;
}

std::unique_ptr<Problem> problem_with(const char* formula, core::Json parameters) {
  const auto own = effects::Expression::from_json(core::Json{{"format", "tractus-effect/1"},
                                                             {"id", "expression:own"},
                                                             {"rig", "probing"},
                                                             {"adds_to", "fz_N"},
                                                             {"formula", formula},
                                                             {"parameters", std::move(parameters)}},
                                                  "", effects::probing_expressions());
  EXPECT_TRUE(own) << own.error().what;
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.0}};
  auto problem = make_probing_problem(
      model, strokes(), {.threads = 1, .user_effects = UserEffects({{own->use(), own->facts()}})});
  EXPECT_TRUE(problem) << problem.error().what;
  return std::move(*problem);
}

core::Json number(const char* unit, double initial, double low, double high) {
  return {{"unit", unit}, {"initial", initial}, {"low", low}, {"high", high}};
}

std::vector<std::string> remarks(const Problem& problem) {
  std::vector<double> base;
  for (const Parameter& p : problem.parameters({})) base.push_back(p.start);
  return likenesses(problem, {"expression:own"}, base, 1);
}

TEST(OwnEffects, TheSameLawUnderAnotherNameIsSaidToBeAlike) {
  const auto problem = problem_with("c * sgn(v_m_s)", {{"c", number("N", 1, 0, 100)}});
  EXPECT_TRUE(check_own_effect(*problem, "expression:own"));
  EXPECT_THAT(remarks(*problem), ::testing::Contains(HasSubstr("Coulomb friction do nearly the")));
}

TEST(OwnEffects, WhatIsAlikeAtSomeOfItsNumbersOnlyIsNotSaidToBe) {
  const auto problem =
      problem_with("c * sgn(v_m_s) * exp(-x_m/l)",
                   {{"c", number("N", 1, 0, 100)}, {"l", number("m", 0.01, 0.001, 0.02)}});
  EXPECT_THAT(remarks(*problem), ::testing::Each(::testing::Not(HasSubstr("nearly the same"))));
}

TEST(OwnEffects, WhatTheBaseDoesAsWellIsSaid) {
  const auto problem = problem_with("c * x_m", {{"c", number("N/m", 1, -1000, 1000)}});
  EXPECT_THAT(remarks(*problem), ::testing::Contains(HasSubstr("own numbers imitate")));
}

TEST(OwnEffects, AFormulaThatIsNoNumberSomewhereIsRefusedWithItsTrial) {
  // Depths run from 2 to 18 mm: the logarithm's argument is below 0 up to 10 mm.
  const auto problem =
      problem_with("c * ln((x_m - h) / l)", {{"c", number("N", 1, 0, 100)},
                                             {"h", number("m", 0.01, 0.001, 0.02)},
                                             {"l", number("m", 0.01, 0.001, 0.1)}});
  const auto fine = check_own_effect(*problem, "expression:own");
  ASSERT_FALSE(fine);
  EXPECT_THAT(fine.error().what, HasSubstr("not a finite number"));
  EXPECT_THAT(fine.error().what, HasSubstr("trial t1"));
}

TEST(OwnEffects, AFormulaThatIsNeverOffIsRefused) {
  const auto problem = problem_with(
      "c + d * v_m_s", {{"c", number("N", 1, 0, 100)}, {"d", number("N*s/m", 1, 0, 100)}});
  const auto fine = check_own_effect(*problem, "expression:own");
  ASSERT_FALSE(fine);
  EXPECT_THAT(fine.error().what, HasSubstr("parameter times the rest"));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
