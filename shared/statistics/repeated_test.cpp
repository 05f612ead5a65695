/// Repeated measures and mixed models against R (car, lme4, lmerTest) and 50-digit values.
#include "statistics/golden_test.hpp"
#include "statistics/lmm.hpp"
#include "statistics/rm_anova.hpp"

namespace statistics {
namespace {

using golden::expect_near;

TEST(RmAnova, AgreesWithRToTenDigitsWithBothCorrections) {
  const auto reference = golden::expected("rm_anova");
  int compared = 0;
  for (const auto& [name, want] : reference["cases"].items()) {
    if (!want.contains("ss_effect")) continue;
    ++compared;
    const auto fit = rm_anova(golden::Csv(want["data"]).numeric_from(1));
    ASSERT_TRUE(fit) << name;
    expect_near(fit->ss_effect, want["ss_effect"], 1e-10, name);
    expect_near(fit->ss_subjects, want["ss_subjects"], 1e-10, name);
    expect_near(fit->ss_error, want["ss_error"], 1e-10, name);
    expect_near(fit->f, want["F"], 1e-10, name + " F");
    expect_near(fit->p, want["p_uncorrected"], 1e-10, name + " p");
    expect_near(fit->epsilon_gg, want["eps_GG"], 1e-10, name + " gg");
    expect_near(fit->p_gg, want["p_GG"], 1e-10, name + " p gg");
    expect_near(fit->epsilon_hf, want["eps_HF_uncapped"], 1e-10, name + " hf");
    expect_near(fit->p_hf, want["p_HF"], 1e-10, name + " p hf");
    expect_near(fit->p_lower, want["p_lower_bound"], 1e-10, name + " p low");
    expect_near(fit->mauchly.w, want["mauchly"]["W"], 1e-10, name + " W");
    expect_near(fit->mauchly.p, want["mauchly"]["p_value_correct"], 1e-10, name + " mauchly");
    expect_near(fit->partial_eta_squared, want["partial_eta2"], 1e-10, name);
    expect_near(fit->generalized_eta_squared, want["generalized_eta2"], 1e-10, name);
    expect_near(fit->partial_omega_squared, want["omega2_partial_SPSSstyle"], 1e-10, name);
  }
  EXPECT_EQ(compared, 5);
}

TEST(RmAnova, ContrastsAgreeWithPairedT) {
  const auto reference = golden::expected("rm_anova");
  const auto& want = reference["cases"]["breach_velocity_mm_s"];
  const Matrix values = golden::Csv(want["data"]).numeric_from(1);
  const auto trend = linear_trend(values);
  expect_near(trend.t, want["linear_trend"]["t"], 1e-10, "trend");
  expect_near(trend.p, want["linear_trend"]["p_value"], 1e-10, "trend");
  expect_near(trend.estimate, want["linear_trend"]["mean_contrast"], 1e-10, "trend");
  const auto pair = contrast(values, Eigen::Vector3d(1.0, -1.0, 0.0));
  expect_near(pair.t, want["paired_t"]["t"][0], 1e-10, "1-2");
  expect_near(pair.ci_low, want["paired_t"]["lwr95"][0], 1e-10, "1-2");
  expect_near(pair.ci_high, want["paired_t"]["upr95"][0], 1e-10, "1-2");
}

TEST(RmAnova, RefusesOneSubjectMissingValuesAndNoError) {
  EXPECT_FALSE(rm_anova(Matrix::Random(1, 3)));
  EXPECT_FALSE(rm_anova(Matrix::Random(3, 1)));
  Matrix values(3, 2);
  values << 1, 2, 2, 3, 3, 4;  // every subject gains exactly 1
  EXPECT_FALSE(rm_anova(values));
  values(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rm_anova(values));
}

struct Fitted {
  Design design;
  Vector y;
  std::vector<std::string> labels;
};

Fitted data_of(const core::Json& want) {
  const golden::Csv csv(want["data"]);
  Fitted out{{csv.numeric_from(2), {}, true}, csv.numbers("y"), csv.texts("group")};
  for (const auto& name : want["columns"]) out.design.names.push_back(name);
  return out;
}

TEST(Lmm, ReachesTheFiftyDigitOptimumToNineDigits) {
  const auto reference = golden::expected("lmm_random_intercept");
  for (const auto& [name, fit_of] : reference["fits"].items()) {
    const auto& want = fit_of["REML"];
    const Fitted data = data_of(fit_of);
    const auto fit = lmm(data.design, data.y, data.labels);
    ASSERT_TRUE(fit) << name << fit.error().what;
    expect_near(fit->criterion, want["criterion"], 1e-9, name);
    expect_near(fit->coefficients, want["fixef"], 1e-9, name + " fixef");
    expect_near(fit->standard_errors, want["se"], 1e-9, name + " se");
    expect_near(fit->t, want["t"], 1e-9, name + " t");
    expect_near(fit->tau_squared, want["tau2"], 1e-9, name + " tau2");
    expect_near(fit->sigma_squared, want["sigma2"], 1e-9, name + " sigma2");
    expect_near(fit->icc, want["ICC"], 1e-9, name + " icc");
    expect_near(fit->group_effects, want["blup"], 1e-9, name + " blup");
    expect_near(fit->rlrt, want["RLRT"], 1e-9, name + " rlrt");
    expect_near(fit->rlrt_p, want["RLRT_p_half_chibar"], 1e-9, name + " rlrt p");
    if (!want.contains("satterthwaite_df")) continue;
    expect_near(fit->df, want["satterthwaite_df"], 1e-9, name + " df");
    expect_near(fit->p, want["p_satterthwaite"], 1e-9, name + " p");
    const Matrix varpar = golden::matrix_of(want["vcov_varpar_tau2_sigma2"]);
    EXPECT_LT((fit->variance_covariance - varpar).norm(), 1e-9 * varpar.norm()) << name;
  }
}

TEST(Lmm, MaximumLikelihoodAgreesToo) {
  const auto reference = golden::expected("lmm_random_intercept");
  for (const auto& [name, fit_of] : reference["fits"].items()) {
    const auto& want = fit_of["ML"];
    const Fitted data = data_of(fit_of);
    const auto fit = lmm_ml(data.design, data.y, data.labels);
    ASSERT_TRUE(fit) << name;
    expect_near(fit->deviance, want["deviance"], 1e-9, name);
    expect_near(fit->coefficients, want["fixef"], 1e-9, name);
    expect_near(fit->tau_squared, want["tau2"], 1e-9, name);
    expect_near(fit->sigma_squared, want["sigma2"], 1e-9, name);
    expect_near(fit->aic, want["AIC"], 1e-9, name);
    expect_near(fit->bic, want["BIC"], 1e-9, name);
  }
}

TEST(Lmm, IsLeastSquaresWhenGroupsDoNotDiffer) {
  // Dyestuff2 was made so that the spread between batches is estimated as 0 (lmerTest: df 29).
  const auto reference = golden::expected("lmm_random_intercept");
  const Fitted data = data_of(reference["fits"]["lmm_dyestuff2"]);
  const auto fit = lmm(data.design, data.y, data.labels);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->tau_squared, 0.0);
  EXPECT_EQ(fit->df[0], 29.0);
  EXPECT_EQ(fit->rlrt_p, 1.0);
}

TEST(Lmm, RefusesOneGroupAndOneObservationEach) {
  const Vector x = Vector::LinSpaced(6, 0.0, 5.0);
  Vector y(6);
  y << 1, 3, 2, 5, 4, 7;
  const Design design = with_intercept(x, {"x"});
  EXPECT_FALSE(lmm(design, y, std::vector<std::string>(6, "a")));
  EXPECT_FALSE(lmm(design, y, {"a", "b", "c", "d", "e", "f"}));
  EXPECT_TRUE(lmm(design, y, {"a", "a", "b", "b", "c", "c"}));
}

}  // namespace
}  // namespace statistics
