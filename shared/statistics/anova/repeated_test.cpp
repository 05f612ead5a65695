/// Repeated measures and mixed models against R (car, lme4, lmerTest) and 50-digit values.
#include "statistics/anova/rm_anova.hpp"
#include "statistics/anova/rm_factorial.hpp"
#include "statistics/golden_test.hpp"
#include "statistics/mixed/lmm_tests.hpp"
#include "statistics/summary/p_adjust.hpp"

namespace tractus {
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
    expect_near(fit->epsilon_lower, want["eps_lower_bound"], 1e-10, name + " lower");
    expect_near(fit->mauchly.chi_squared, want["mauchly"]["chi2_z"], 1e-10, name + " z");
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
  std::vector<double> p;
  std::size_t at = 0;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    Vector weights = Vector::Zero(3);
    weights[a] = 1.0;
    weights[b] = -1.0;
    const auto pair = contrast(values, weights);
    expect_near(pair.t, want["paired_t"]["t"][at], 1e-10, "t");
    expect_near(pair.p, want["paired_t"]["p_raw"][at], 1e-10, "p");
    expect_near(pair.estimate, want["paired_t"]["mean_diff"][at], 1e-10, "difference");
    expect_near(pair.ci_low, want["paired_t"]["lwr95"][at], 1e-10, "low");
    expect_near(pair.ci_high, want["paired_t"]["upr95"][at++], 1e-10, "high");
    p.push_back(pair.p);
  }
  const auto holm = adjusted(p, Adjustment::holm);
  for (std::size_t i = 0; i < 3; ++i)
    expect_near(holm[i], want["paired_t"]["p_holm"][i], 1e-10, "holm");
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

/// One effect against row `at` of a table by R's car (sum contrasts, type III).
void expect_effect(const RmEffect& got, const core::Json& want, std::size_t at) {
  const std::string name = want["terms"][at];
  expect_near(got.ss, want["ss"][at], 1e-10, name + " ss");
  expect_near(got.ss_error, want["error_ss"][at], 1e-10, name + " error");
  EXPECT_EQ(got.df1, want["num_df"][at].get<double>());
  EXPECT_EQ(got.df2, want["den_df"][at].get<double>());
  expect_near(got.f, want["F"][at], 1e-10, name + " F");
  expect_near(got.p, want["p"][at], 1e-9, name + " p");
}

void expect_corrections(const RmEffect& got, const core::Json& want, std::size_t at) {
  const std::string name = want["eps_terms"][at];
  expect_near(got.epsilon_gg, want["eps_GG"][at], 1e-10, name + " gg");
  expect_near(got.p_gg, want["p_GG"][at], 1e-10, name + " p gg");
  expect_near(got.epsilon_hf, want["eps_HF"][at], 1e-10, name + " hf");
  expect_near(got.p_hf, want["p_HF"][at], 1e-10, name + " p hf");
}

TEST(RmFactorial, TwoWithinFactorsAgreeWithCar) {
  const auto reference = golden::expected("rm_anova");
  const auto& want = reference["cases"]["two_within_2x3"];
  const auto got = rm_factorial({golden::Csv(want["data"]).numeric_from(1), {2, 3}, {}});
  ASSERT_TRUE(got) << got.error().what;
  ASSERT_EQ(got->size(), 3u);  // scenario, repetition, both
  for (std::size_t i = 0; i < 3; ++i) {
    expect_effect((*got)[i], want, i + 1);
    expect_near((*got)[i].partial_eta_squared, want["partial_eta2"][i + 1], 1e-10, "partial");
    expect_near((*got)[i].generalized_eta_squared, want["generalized_eta2_all_within"][i + 1],
                1e-10, "generalised");
  }
  expect_corrections((*got)[1], want, 0);
  expect_corrections((*got)[2], want, 1);
}

TEST(RmFactorial, AGroupBetweenSubjectsAgreesWithCarsTypeThree) {
  const auto reference = golden::expected("rm_anova");
  const auto& want = reference["cases"]["mixed_group_x_rep"]["typeIII_sum_contrasts"];
  const golden::Csv csv("data/sim_rm_lateral_breach_velocity_mm_s.csv");
  // senior S01-S02, fellow S03-S06, resident S07-S10: unequal groups
  const auto got = rm_factorial({csv.numeric_from(1), {3}, {0, 0, 1, 1, 1, 1, 2, 2, 2, 2}});
  ASSERT_TRUE(got) << got.error().what;
  ASSERT_EQ(got->size(), 3u);  // group, repetition, both
  for (std::size_t i = 0; i < 3; ++i) expect_effect((*got)[i], want, i + 1);
  for (std::size_t i = 0; i < 2; ++i) {
    expect_corrections((*got)[i + 1], want, i);
    expect_near((*got)[i + 1].mauchly.w, want["mauchly_W"][i], 1e-10, "W");
  }
}

TEST(RmFactorial, WithOneFactorIsTheSimpleAnalysisAndRefusesGroupsOfOne) {
  const auto reference = golden::expected("rm_anova");
  const Matrix values = golden::Csv(reference["cases"]["force_var_N2"]["data"]).numeric_from(1);
  const auto simple = rm_anova(values);
  const auto got = rm_factorial({values, {3}, {}});
  ASSERT_TRUE(got);
  EXPECT_NEAR((*got)[0].f, simple->f, 1e-12 * simple->f);
  EXPECT_NEAR((*got)[0].p_gg, simple->p_gg, 1e-12);
  EXPECT_FALSE(rm_factorial({values, {3}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}));
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
    EXPECT_LT((fit->curvature.variance_covariance - varpar).norm(), 1e-9 * varpar.norm()) << name;
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

TEST(LmmTests, AgreeWithLmerTestAndPbkrtest) {
  // R's optimum of τ² is good to 3e-8, which bounds what depends on it.
  const auto reference = golden::expected("lmm_random_intercept");
  int joint = 0;
  for (const auto& [name, fit_of] : reference["fits"].items()) {
    const auto& want = fit_of["lme4_lmerTest_pbkrtest"];
    if (!want.contains("KR_df")) continue;
    const Fitted data = data_of(fit_of);
    const auto fit = lmm(data.design, data.y, data.labels);
    ASSERT_TRUE(fit) << name;
    const auto kr = kenward_roger(*fit);
    expect_near(kr.df, want["KR_df"], 1e-6, name + " KR df");
    expect_near(kr.standard_errors, want["KR_se"], 1e-6, name + " KR se");
    if (!want.contains("anova_repetition")) continue;
    const auto& f = want["anova_repetition"];
    const auto satterthwaite = joint_test(*fit, {1, 2}, SmallSample::satterthwaite);
    expect_near(satterthwaite.statistic, f["F_satt"], 1e-6, name + " F");
    expect_near(satterthwaite.df2, f["den_satt"], 1e-6, name + " df");
    expect_near(satterthwaite.p, f["p_satt"], 1e-6, name + " p");
    const auto kenward = joint_test(*fit, {1, 2}, SmallSample::kenward_roger);
    expect_near(kenward.statistic, f["F_KR"], 1e-6, name + " KR F");
    expect_near(kenward.df2, f["den_KR"], 1e-6, name + " KR df2");
    expect_near(kenward.p, f["p_KR"], 1e-6, name + " KR p");
    ++joint;
  }
  EXPECT_EQ(joint, 2);
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
}  // namespace tractus
