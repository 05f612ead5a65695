/// Mixed models with any random terms, against lme4 and lmerTest
/// (tests/golden/statistics-reference/lmm_random_terms.R), and their tests after Kenward and Roger
/// against pbkrtest (kenward_roger.R).
#include "statistics/mixed/mixed_model.hpp"

#include <cmath>
#include <map>
#include <random>

#include "statistics/mixed/golden_terms_test.hpp"
#include "statistics/mixed/kenward_roger.hpp"
#include "statistics/mixed/lmm.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::design_of;
using golden::expect_near;
using golden::expect_random;
using golden::key_of;
using golden::random_term;
using golden::Term;

const std::map<std::string, std::vector<Term>> kTerms = {
    {"sim_crossed_1", {{{"surgeon"}}, {{"scenario"}}}},
    {"sim_crossed_2", {{{"surgeon"}, "trial"}, {{"scenario"}}}},
    {"sim_crossed_3", {{{"surgeon"}, "trial"}, {{"scenario"}}}},
    {"sim_crossed_4", {{{"surgeon"}, "trial", false}, {{"surgeon"}}}},
    {"sim_crossed_5", {{{"surgeon"}}, {{"scenario"}}}},
    {"sim_crossed_6", {{{"surgeon"}, "trial"}, {{"scenario"}, "trial"}}},
    {"penicillin", {{{"plate"}}, {{"sample"}}}},
    {"pastes", {{{"batch"}}, {{"batch", "cask"}}}}};

TEST(MixedModelTest, AgreesWithLme4ToSixDigits) {
  const auto reference = golden::expected("lmm_random_terms");
  int compared = 0;
  for (const auto& [name, want] : reference["fits"].items()) {
    const golden::Csv csv(want["data"]);
    const Vector y = csv.numbers(want["response"]);
    std::vector<RandomTerm> terms;
    for (const Term& term : kTerms.at(name)) terms.push_back(random_term(csv, term));
    const Design design = design_of(csv, want["formula"], y.size());
    const auto fit = mixed_model(design, y, terms);
    ASSERT_TRUE(fit) << name << ": " << fit.error().what;
    ++compared;
    EXPECT_TRUE(fit->converged) << name;
    EXPECT_EQ(fit->singular, want["singular"].get<bool>()) << name;
    expect_near(fit->criterion, want["reml_criterion"], 1e-9, name + " criterion");
    expect_near(fit->coefficients, golden::as_list(want["fixef"]), 1e-6, name + " fixef");
    expect_near(fit->standard_errors, golden::as_list(want["se"]), 1e-6, name + " se");
    expect_near(fit->sigma_squared, want["sigma_squared"], 1e-6, name + " sigma");
    // lmerTest differentiates numerically too, from where its own search ended.
    if (!fit->singular) expect_near(fit->df, golden::as_list(want["df"]), 1e-4, name + " df");
    for (std::size_t t = 0; t < terms.size(); ++t)
      expect_random(fit->random[t], want["covariances"][key_of(fit->random, t)], name);
    const auto ml = mixed_model(design, y, terms, Likelihood::ml);
    ASSERT_TRUE(ml) << name << ": " << ml.error().what;
    expect_near(ml->criterion, want["ml"]["deviance"], 1e-9, name + " deviance");
    expect_near(ml->coefficients, golden::as_list(want["ml"]["fixef"]), 1e-6, name + " ML fixef");
    expect_near(ml->sigma_squared, want["ml"]["sigma_squared"], 1e-6, name + " ML sigma");
  }
  EXPECT_EQ(compared, 8);
}

TEST(MixedModelTest, PredictsTheEffectsOfLevelsAsLme4Does) {
  const auto reference = golden::expected("lmm_random_terms");
  for (const char* name : {"sim_crossed_2", "penicillin"}) {
    const auto& want = reference["fits"][name];
    const golden::Csv csv(want["data"]);
    const Vector y = csv.numbers(want["response"]);
    std::vector<RandomTerm> terms;
    for (const Term& term : kTerms.at(name)) terms.push_back(random_term(csv, term));
    const auto fit = mixed_model(design_of(csv, want["formula"], y.size()), y, terms);
    ASSERT_TRUE(fit) << fit.error().what;
    for (const auto& part : fit->random) {
      const std::string level = want["first_levels"][part.group];
      const auto at = std::ranges::find(part.levels, level) - part.levels.begin();
      expect_near(Vector(part.effects.row(at)), golden::as_list(want["first_effects"][part.group]),
                  1e-5, std::string(name) + " " + part.group);
    }
  }
}

TEST(MixedModelTest, OneRandomInterceptIsTheClosedFormOfLmm) {
  const golden::Csv simulated("data/sim_crossed_1.csv");
  const Vector y = simulated.numbers("y");
  const Design design = with_intercept(simulated.numbers("trial"), {"trial"});
  const auto labels = simulated.texts("surgeon");
  const auto closed = lmm(design, y, labels);
  const auto fit =
      mixed_model(design, y, {{"surgeon", labels, Matrix::Ones(y.size(), 1), {"(Intercept)"}}});
  ASSERT_TRUE(closed && fit);
  EXPECT_NEAR(fit->criterion, closed->criterion, 1e-9 * closed->criterion);
  EXPECT_NEAR(fit->random[0].covariance(0, 0), closed->tau_squared, 1e-7 * closed->tau_squared);
  for (int j = 0; j < 2; ++j) {
    EXPECT_NEAR(fit->coefficients[j], closed->coefficients[j], 1e-9);
    EXPECT_NEAR(fit->df[j], closed->df[j], 1e-5 * closed->df[j]);
  }
  const auto joint = joint_test(*fit, {1});
  EXPECT_NEAR(joint.statistic, fit->t[1] * fit->t[1], 1e-9 * joint.statistic);
  EXPECT_NEAR(joint.p, fit->p[1], 1e-12);
}

TEST(MixedModelTest, SaysWhatCannotBeEstimated) {
  Vector y(6), x(6);
  y << 1, 2, 4, 3, 5, 7;
  x << 1, 2, 3, 4, 5, 6;
  const Design design = with_intercept(x, {"x"});
  const Matrix ones = Matrix::Ones(6, 1);
  const auto refusal = [&](const RandomTerm& term) {
    const auto fit = mixed_model(design, y, {term});
    return fit ? "" : fit.error().what;
  };
  EXPECT_EQ(refusal({"a", {"p", "p", "p", "p", "p", "p"}, ones, {"1"}}),
            "a: one level: the spread between its levels cannot be estimated");
  EXPECT_NE(refusal({"a", {"p", "q", "r", "s", "t", "u"}, ones, {"1"}}).find("as many effects"),
            std::string::npos);
  EXPECT_NE(refusal({"a", {"p", "q", "p", "q", "p", "q"}, Matrix::Zero(6, 1), {"x"}})
                .find("the slope's column x is 0"),
            std::string::npos);
}

TEST(MixedModelTest, KenwardAndRogersTestsAgreeWithPbkrtest) {
  const auto reference = golden::expected("kenward_roger");
  const auto fits = golden::expected("lmm_random_terms");
  int compared = 0, joint_tests = 0;
  for (const auto& [name, want] : reference["fits"].items()) {
    const auto& of = fits["fits"][name];
    const golden::Csv csv(of["data"]);
    const Vector y = csv.numbers(of["response"]);
    std::vector<RandomTerm> terms;
    for (const Term& term : kTerms.at(name)) terms.push_back(random_term(csv, term));
    const Design design = design_of(csv, of["formula"], y.size());
    const auto fit = mixed_model(design, y, terms);
    ASSERT_TRUE(fit) << name << ": " << fit.error().what;
    const auto tests = kenward_roger(*fit, design, terms);
    ASSERT_TRUE(tests) << name << ": " << tests.error().what;
    ++compared;
    expect_near(tests->standard_errors, golden::as_list(want["se"]), 1e-6, name + " se");
    expect_near(tests->df, golden::as_list(want["df"]), 1e-6, name + " df");
    if (!want["joint"].contains("F")) continue;
    ++joint_tests;
    std::vector<Eigen::Index> columns;
    for (Eigen::Index j = 1; j < design.columns.cols(); ++j) columns.push_back(j);
    const auto joint = joint_test(*tests, columns);
    expect_near(joint.statistic, want["joint"]["F"], 1e-6, name + " F");
    expect_near(joint.df2, want["joint"]["df2"], 1e-6, name + " df of F");
    expect_near(joint.p, want["joint"]["p"], 1e-4, name + " p of F");
  }
  EXPECT_EQ(compared, 7);
  EXPECT_EQ(joint_tests, 1);
}

TEST(MixedModelTest, KenwardAndRogersTestsRefuseManyLevels) {
  std::vector<std::string> labels;
  for (int i = 0; i < 6003; ++i) labels.push_back(std::to_string(i % 2001));
  const Vector x = Vector::LinSpaced(6003, 0.0, 1.0);
  const std::vector<RandomTerm> terms = {{"a", labels, Matrix::Ones(6003, 1), {"1"}}};
  const auto tests = kenward_roger(MixedModel{}, with_intercept(x, {"x"}), terms);
  ASSERT_FALSE(tests);
  EXPECT_NE(tests.error().what.find("at most 2000 random effects, these terms have 2001"),
            std::string::npos);
}

/// Many levels in two groupings: the second is factorised sparsely. A balanced nested design's
/// estimates are those of its analysis of variance (Searle, Casella & McCulloch 1992, section 4.7):
/// σ² = MS_E, τ_b² = (MS_B − MS_E)/r, τ_a² = (MS_A − MS_B)/br, se² = MS_A/abr on a − 1 df.
TEST(MixedModelTest, BalancedNestedLevelsHaveTheEstimatesOfTheirAnalysisOfVariance) {
  constexpr int kA = 3500, kB = 2, kR = 2, kRows = kA * kB * kR;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Vector y(kRows);
  std::vector<std::string> a(kRows), b(kRows);
  double ms_a = 0.0, ms_b = 0.0, ms_e = 0.0;
  std::vector<double> means;
  for (int i = 0, row = 0; i < kA; ++i) {
    const double own = normal(random);
    double of_b[kB];
    for (int j = 0; j < kB; ++j) {
      const double both = own + 0.7 * normal(random);
      const int first = row;
      for (int k = 0; k < kR; ++k, ++row) {
        y[row] = 5.0 + both + 0.5 * normal(random);
        a[std::size_t(row)] = std::to_string(i);
        b[std::size_t(row)] = std::to_string(i) + ":" + std::to_string(j);
      }
      of_b[j] = y.segment(first, kR).mean();
      ms_e += (y.segment(first, kR).array() - of_b[j]).square().sum() / (kA * kB * (kR - 1));
    }
    means.push_back(0.5 * (of_b[0] + of_b[1]));
    for (const double mean : of_b) ms_b += kR * std::pow(mean - means.back(), 2) / (kA * (kB - 1));
  }
  for (const double mean : means) ms_a += kB * kR * std::pow(mean - y.mean(), 2) / (kA - 1);
  const Design design{Matrix::Ones(kRows, 1), {"(Intercept)"}, true};
  const auto fit = mixed_model(
      design, y,
      {{"a", a, Matrix::Ones(kRows, 1), {"1"}}, {"a:b", b, Matrix::Ones(kRows, 1), {"1"}}});
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_NEAR(fit->sigma_squared, ms_e, 1e-6 * ms_e);
  EXPECT_NEAR(fit->random[1].covariance(0, 0), (ms_b - ms_e) / kR, 1e-6);
  EXPECT_NEAR(fit->random[0].covariance(0, 0), (ms_a - ms_b) / (kB * kR), 1e-6);
  EXPECT_NEAR(fit->coefficients[0], y.mean(), 1e-9);
  EXPECT_NEAR(fit->standard_errors[0], std::sqrt(ms_a / kRows), 1e-7);
  EXPECT_NEAR(fit->df[0], kA - 1, 1e-3 * kA);
}

TEST(MixedModelTest, IsStoppedWhenAsked) {
  const golden::Csv csv("data/sim_crossed_1.csv");
  const Vector y = csv.numbers("y");
  const auto fit =
      mixed_model(with_intercept(csv.numbers("trial"), {"trial"}), y,
                  {{"surgeon", csv.texts("surgeon"), Matrix::Ones(y.size(), 1), {"(Intercept)"}}},
                  Likelihood::reml, [](double) { return false; });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, core::Errc::cancelled);
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
