/// Logistic mixed models with any random terms, against lme4's glmer
/// (tests/golden/statistics-reference/logistic_random_terms.R).
#include "statistics/mixed/logistic_mixed_model.hpp"

#include <cmath>
#include <map>
#include <random>

#include "statistics/mixed/derivatives.hpp"
#include "statistics/mixed/golden_terms_test.hpp"
#include "statistics/mixed/laplace.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;
using golden::Term;

const std::map<std::string, std::vector<Term>> kLogisticTerms = {
    {"sim_logistic_1", {{{"surgeon"}}, {{"scenario"}}}},
    {"sim_logistic_2", {{{"surgeon"}, "trial"}, {{"scenario"}}}},
    {"sim_logistic_3", {{{"hospital"}}, {{"hospital", "surgeon"}}}},
    {"sim_logistic_4", {{{"surgeon"}, "trial", false}, {{"surgeon"}}}},
    {"sim_logistic_5", {{{"surgeon"}}, {{"scenario"}}}},
    {"sim_logistic_6", {{{"surgeon"}, "trial"}, {{"scenario"}, "trial"}}},
    {"sim_logistic_7", {{{"surgeon"}, "trial"}}},
    {"verbal_aggression", {{{"surgeon"}}, {{"scenario"}}}}};

/// One fit of the reference: its data as the model takes them.
struct LogisticCase {
  std::string name;
  core::Json want;
  Counts counts;
  Design design;
  std::vector<RandomTerm> terms;
};

std::vector<LogisticCase> logistic_cases() {
  std::vector<LogisticCase> out;
  const auto reference = golden::expected("logistic_random_terms");
  for (const auto& [name, want] : reference["fits"].items()) {
    const golden::Csv csv(want["data"]);
    LogisticCase of{name, want, {csv.numbers("y"), csv.numbers("m")}, {}, {}};
    of.design = golden::design_of(csv, want["formula"], of.counts.trials.size());
    for (const Term& term : kLogisticTerms.at(name))
      of.terms.push_back(golden::random_term(csv, term));
    out.push_back(std::move(of));
  }
  EXPECT_EQ(out.size(), kLogisticTerms.size());
  return out;
}

/// θ in units of the scaled columns, from triangles by the keys of lme4's answer.
Vector theta_of(const core::Json& lambda, const LogisticCase& of, const LaplaceDeviance& deviance) {
  std::vector<RandomPart> parts(of.terms.size());
  for (std::size_t t = 0; t < parts.size(); ++t) parts[t].group = of.terms[t].group;
  Vector out(deviance.squares().start().size());
  Eigen::Index at = 0;
  for (std::size_t t = 0; t < parts.size(); ++t) {
    const Matrix block = deviance.squares().terms()[t].scale.asDiagonal() *
                         golden::matrix_of(lambda[golden::key_of(parts, t)]);
    for (Eigen::Index c = 0; c < block.cols(); ++c)
      for (Eigen::Index r = c; r < block.rows(); ++r) out[at++] = block(r, c);
  }
  return out;
}

TEST(LogisticMixedModelTest, HasTheDevianceOfLme4AtGivenParameters) {
  int compared = 0;
  for (const LogisticCase& of : logistic_cases()) {
    LaplaceDeviance deviance(of.design.columns, of.counts, of.terms);
    for (const auto& point : of.want["points"]) {
      const Vector beta = deviance.squares().column_scale().cwiseProduct(
          golden::vector_of(golden::as_list(point["beta"])));
      expect_near(deviance.value(theta_of(point["lambda"], of, deviance), beta), point["deviance"],
                  1e-10, of.name);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 24);
}

TEST(LogisticMixedModelTest, HasTheGradientOfItsDeviance) {
  for (const LogisticCase& of : logistic_cases()) {
    if (of.name == "verbal_aggression") continue;  // nothing new, and slow by differences
    LaplaceDeviance deviance(of.design.columns, of.counts, of.terms);
    const auto& point = of.want["points"][0];
    const Vector theta = theta_of(point["lambda"], of, deviance);
    Vector x(theta.size() + of.design.columns.cols());
    x << theta, deviance.squares().column_scale().cwiseProduct(
                    golden::vector_of(golden::as_list(point["beta"])));
    const auto p = of.design.columns.cols();
    const Vector numeric = numeric_gradient(
        [&](const Vector& at) { return deviance.value(at.head(theta.size()), at.tail(p)); }, x,
        2e-3);
    const auto exact = deviance.gradient(x.head(theta.size()), x.tail(p));
    Vector ours(x.size());
    ours << exact.theta, exact.beta;
    EXPECT_LT((ours - numeric).cwiseAbs().maxCoeff(), 1e-6 * (1.0 + numeric.cwiseAbs().maxCoeff()))
        << of.name << "\n"
        << ours.transpose() << "\n"
        << numeric.transpose();
  }
}

TEST(LogisticMixedModelTest, AgreesWithLme4ToSixDigits) {
  for (const LogisticCase& of : logistic_cases()) {
    const auto fit = logistic_mixed_model(of.design, of.counts, of.terms);
    ASSERT_TRUE(fit) << of.name << ": " << fit.error().what;
    EXPECT_TRUE(fit->converged) << of.name;
    EXPECT_EQ(fit->singular, of.want["singular"].get<bool>()) << of.name;
    expect_near(-2.0 * fit->log_likelihood, of.want["deviance"], 1e-10, of.name + " deviance");
    expect_near(fit->aic, of.want["aic"], 1e-10, of.name + " AIC");
    expect_near(fit->coefficients, golden::as_list(of.want["fixef"]), 1e-6, of.name + " fixef");
    expect_near(fit->standard_errors, golden::as_list(of.want["se"]), 1e-6, of.name + " se");
    // glmer itself takes its Hessian by simple differences with steps of 1e-4.
    expect_near(fit->standard_errors, golden::as_list(of.want["glmer_se"]), 2e-3,
                of.name + " se as printed by glmer");
    for (std::size_t t = 0; t < of.terms.size(); ++t) {
      const RandomPart& part = fit->random[t];
      const std::string key = golden::key_of(fit->random, t);
      golden::expect_random(part, of.want["covariances"][key], of.name);
      const std::string level = of.want["first_levels"][key];
      const auto at = std::ranges::find(part.levels, level) - part.levels.begin();
      const Vector want = golden::vector_of(golden::as_list(of.want["first_effects"][key]));
      EXPECT_LT((part.effects.row(at).transpose() - want).cwiseAbs().maxCoeff(),
                1e-6 * (1.0 + want.cwiseAbs().maxCoeff()))
          << of.name << " " << key;
    }
  }
}

/// Many levels of two groupings that do not nest: the second is factorised sparsely, and its inverse
/// known where the factor has entries alone.
TEST(LogisticMixedModelTest, HasTheGradientOfItsDevianceWhereItIsSparse) {
  constexpr int kRows = 13'000, kLevels = 3200;
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  Counts counts{Vector(kRows), Vector::Constant(kRows, 3.0)};
  Matrix x(kRows, 2);
  RandomTerm first{"a", {}, Matrix::Ones(kRows, 1), {"1"}}, second{"b", {}, x, {"1", "x"}};
  second.columns.col(0).setOnes();
  for (int i = 0; i < kRows; ++i) {
    counts.successes[i] = double(random() % 4);
    x.row(i) << 1.0, normal(random);
    second.columns(i, 1) = x(i, 1);
    first.labels.push_back(std::to_string(i % 6500));
    second.labels.push_back(std::to_string((i * 7 / 4) % kLevels));
  }
  const std::vector<RandomTerm> terms = {first, second};
  LaplaceDeviance deviance(x, counts, terms);
  Vector at(6);
  at << 0.7, 0.6, 0.2, 0.5, 0.1, -0.2;
  const Vector numeric = numeric_gradient(
      [&](const Vector& where) { return deviance.value(where.head(4), where.tail(2)); }, at, 2e-3);
  const auto exact = deviance.gradient(at.head(4), at.tail(2));
  EXPECT_LT((exact.theta - numeric.head(4)).cwiseAbs().maxCoeff(), 1e-7 * numeric.norm());
  EXPECT_LT((exact.beta - numeric.tail(2)).cwiseAbs().maxCoeff(), 1e-7 * numeric.norm());
}

TEST(LogisticMixedModelTest, RefusesWhatHasNoMaximum) {
  Vector x(8), y(8);
  x << 1, 2, 3, 4, 1, 2, 3, 4;
  y << 0, 0, 1, 1, 0, 0, 1, 1;
  const Matrix ones = Matrix::Ones(8, 1);
  const std::vector<std::string> labels = {"p", "p", "p", "p", "q", "q", "q", "q"};
  const Counts counts{y, Vector::Ones(8)};
  const auto by_columns =
      logistic_mixed_model(with_intercept(x, {"x"}), counts, {{"a", labels, ones, {"1"}}});
  ASSERT_FALSE(by_columns);
  EXPECT_NE(by_columns.error().what.find("separate"), std::string::npos) << by_columns.error().what;
  const Design mean{Matrix::Ones(8, 1), {"(Intercept)"}, true};
  const auto one_level =
      logistic_mixed_model(mean, counts, {{"a", std::vector<std::string>(8, "p"), ones, {"1"}}});
  ASSERT_FALSE(one_level);
  EXPECT_EQ(one_level.error().what,
            "a: one level: the spread between its levels cannot be estimated");
  Vector by_level(8);
  by_level << 0, 0, 0, 0, 1, 1, 1, 1;
  const auto separated =
      logistic_mixed_model(mean, {by_level, Vector::Ones(8)}, {{"a", labels, ones, {"1"}}});
  ASSERT_FALSE(separated);
  EXPECT_NE(separated.error().what.find("no maximum"), std::string::npos);
  std::vector<std::string> each;
  for (int i = 0; i < 8; ++i) each.push_back(std::to_string(i));
  const auto row_each = logistic_mixed_model(mean, counts, {{"a", each, ones, {"1"}}});
  ASSERT_FALSE(row_each);
  EXPECT_NE(row_each.error().what.find("as many effects"), std::string::npos);
}

TEST(LogisticMixedModelTest, IsStoppedWhenAsked) {
  const LogisticCase of = logistic_cases().front();
  const auto fit =
      logistic_mixed_model(of.design, of.counts, of.terms, [](double) { return false; });
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, core::Errc::cancelled);
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
