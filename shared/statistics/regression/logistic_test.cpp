/// Logistic regression against 50-digit values of the paper's counts and of simulated trials.
#include "statistics/regression/logistic.hpp"

#include "statistics/golden_test.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;

struct Fixture {
  Design design;
  Counts counts;
};

Fixture paper(const std::string& column, double trials) {
  const golden::Csv csv("data/paper_table2_table4.csv");
  const Vector y = csv.numbers(column);
  return {with_intercept(csv.numbers("experience_years"), {"experience_years"}),
          {y, Vector::Constant(y.size(), trials)}};
}

Fixture simulated_trials() {
  const golden::Csv csv("data/sim_cohort_trials.csv");
  const Vector y = csv.numbers("correct");
  const auto scenario = csv.texts("scenario");
  Matrix x = Matrix::Zero(y.size(), 5);
  x.col(0) = csv.numbers("experience_years");
  x.col(1) = csv.numbers("repetition");
  const std::vector<std::string> levels = {"hard", "lateral", "inoutin"};
  for (std::size_t i = 0; i < scenario.size(); ++i)
    for (std::size_t j = 0; j < levels.size(); ++j)
      if (scenario[i] == levels[j]) x(Eigen::Index(i), Eigen::Index(j) + 2) = 1.0;
  return {with_intercept(x, {"experience", "repetition", "hard", "lateral", "inoutin"}),
          {y, Vector::Ones(y.size())}};
}

void expect_fit(const Fixture& data, const core::Json& want, const std::string& name) {
  const auto fit = logistic(data.design, data.counts);
  ASSERT_TRUE(fit) << name << fit.error().what;
  expect_near(fit->coefficients, want["coef"], 1e-11, name + " coef");
  expect_near(fit->standard_errors, want["se"], 1e-11, name + " se");
  expect_near(fit->z, want["z"], 1e-11, name + " z");
  expect_near(fit->p, want["p_wald"], 1e-11, name + " p");
  expect_near(fit->deviance, want["deviance"], 1e-11, name + " deviance");
  expect_near(fit->null_deviance, want["null_deviance"], 1e-11, name + " null");
  expect_near(fit->log_likelihood, want["logLik"], 1e-11, name + " logLik");
  expect_near(fit->aic, want["AIC"], 1e-11, name + " AIC");
  expect_near(fit->lr_chi_squared, want["LR_chi2"], 1e-11, name + " LR");
  expect_near(fit->lr_p, want["LR_p"], 1e-11, name + " LR p");
  expect_near(fit->dispersion, want["dispersion_pearson"], 1e-11, name + " dispersion");
  expect_near(fit->ci_low, want["wald_ci95_lower"], 1e-11, name + " ci");
  expect_near(fit->ci_high, want["wald_ci95_upper"], 1e-11, name + " ci");
  expect_near(fit->coefficients.array().exp().matrix(), want["odds_ratio"], 1e-11, name + " OR");
  EXPECT_EQ(fit->df_residual, want["df_resid"].get<double>()) << name;
  EXPECT_EQ(fit->lr_df, want["LR_df"].get<double>()) << name;
  expect_near(fit->fitted, want["fitted"], 1e-11, name + " fitted");
  if (!want.contains("quasibinomial")) return;
  const auto quasi = quasi_binomial(*fit);
  expect_near(quasi.standard_errors, want["quasibinomial"]["se"], 1e-11, name + " quasi se");
  expect_near(quasi.p, want["quasibinomial"]["p"], 1e-11, name + " quasi p");
  for (Eigen::Index j = 0; j < fit->coefficients.size(); ++j) {
    const auto ends = profile_interval(data.design, data.counts, *fit, j);
    ASSERT_TRUE(ends) << name;
    const auto at = static_cast<std::size_t>(j);
    expect_near(ends->first, want["profile_ci95_exact_lower"][at], 1e-11, name + " profile");
    expect_near(ends->second, want["profile_ci95_exact_upper"][at], 1e-11, name + " profile");
  }
}

TEST(LogisticRegression, AgreesToElevenDigitsOnPaperCountsAndTrials) {
  const auto want = golden::expected("logistic");
  expect_fit(paper("wrong_breach", 6.0), want["paper_table2"], "table2");
  expect_fit(paper("wrong_total", 12.0), want["paper_table4"], "table4");
  expect_fit(simulated_trials(), want["sim_trials"], "trials");
}

TEST(LogisticRegression, OfAnInterceptAloneHasTheHomogeneityOfSurgeonsAsItsDispersion) {
  const auto want = golden::expected("proportions")["clustered"];
  for (const auto& [name, column, trials] :
       {std::tuple{"breach", "wrong_breach", 6.0}, std::tuple{"total", "wrong_total", 12.0}}) {
    Fixture data = paper(column, trials);
    data.design = with_intercept(Matrix(data.counts.trials.size(), 0), {});
    const auto fit = logistic(data.design, data.counts);
    ASSERT_TRUE(fit) << fit.error().what;
    expect_near(fit->dispersion, want[name]["dispersion_phi"], 1e-12, name);
    expect_near(fit->dispersion * fit->df_residual, want[name]["chi2_homogeneity"], 1e-12, name);
  }
}

TEST(LogisticRegression, AddingUpRowsThatAreAlikeChangesNothing) {
  // Every trial ten times over as rows, and as counts: one likelihood, so one maximum.
  const golden::Csv csv("data/paper_table2_table4.csv");
  const Vector wrong = csv.numbers("wrong_breach"), years = csv.numbers("experience_years");
  Vector y(600), x(600);
  for (Eigen::Index i = 0, row = 0; i < 10; ++i)
    for (int trial = 0; trial < 60; ++trial, ++row) {
      x[row] = years[i];
      y[row] = trial < 10.0 * wrong[i] ? 1.0 : 0.0;
    }
  const auto rows = logistic(with_intercept(x, {"x"}), {y, Vector::Ones(600)});
  const auto counts =
      logistic(with_intercept(years, {"x"}), {10.0 * wrong, Vector::Constant(10, 60.0)});
  ASSERT_TRUE(rows && counts);
  EXPECT_LT((rows->coefficients - counts->coefficients).norm(), 1e-12);
  EXPECT_LT((rows->covariance - counts->covariance).norm(), 1e-13);
  EXPECT_EQ(rows->df_residual, 598.0);
}

TEST(LogisticRegression, SaysSeparationAndFirthStaysFinite) {
  const auto reference = golden::expected("logistic");
  const auto& want = reference["firth"]["separated"];
  const Vector y = golden::vector_of(want["y"]);
  const Design design = with_intercept(golden::vector_of(want["x"]), {"x"});
  const Counts counts{y, Vector::Ones(y.size())};
  const auto fit = logistic(design, counts);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, core::Errc::out_of_range);
  const auto firth = firth_logistic(design, counts);
  ASSERT_TRUE(firth);
  expect_near(firth->coefficients, want["coef"], 1e-11, "coef");
  expect_near(firth->standard_errors, want["se"], 1e-11, "se");
  expect_near(firth->penalised_log_likelihood, want["pen_logLik_no_binomial_const"], 1e-11, "ll");
}

TEST(LogisticRegression, FirthAgreesOnThePaperCounts) {
  const auto reference = golden::expected("logistic");
  const auto& want = reference["firth"]["paper_table2"];
  const Fixture data = paper("wrong_breach", 6.0);
  const auto firth = firth_logistic(data.design, data.counts);
  ASSERT_TRUE(firth);
  expect_near(firth->coefficients, want["coef"], 1e-11, "coef");
  expect_near(firth->standard_errors, want["se"], 1e-11, "se");
  expect_near(firth->penalised_log_likelihood, want["pen_logLik_no_binomial_const"], 1e-11, "ll");
}

TEST(LogisticRegression, RefusesWhatIsNoCount) {
  Fixture data = paper("wrong_breach", 6.0);
  data.counts.successes[2] = 7.0;
  EXPECT_EQ(logistic(data.design, data.counts).error().what,
            "row 3: 7 of 6 is not a count of successes");
  data.counts.successes.setZero();
  EXPECT_FALSE(logistic(data.design, data.counts));
  EXPECT_FALSE(firth_logistic(data.design, data.counts));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
