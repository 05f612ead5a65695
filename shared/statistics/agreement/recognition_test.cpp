/// Proportions, signal detection, confusion and corrections for several tests.
#include "statistics/agreement/confusion.hpp"
#include "statistics/agreement/signal_detection.hpp"
#include "statistics/golden_test.hpp"
#include "statistics/summary/p_adjust.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;

void expect_interval(const Interval& got, const core::Json& want, const std::string& what) {
  expect_near(got.low, want[0], 1e-12, what + " low");
  expect_near(got.high, want[1], 1e-12, what + " high");
}

TEST(Proportions, IntervalsAgreeToTwelveDigits) {
  const auto reference = golden::expected("proportions");
  for (const auto& want : reference["intervals"]) {
    const auto of = Proportion::make(want["x"], want["n"]);
    ASSERT_TRUE(of);
    const std::string what = want["x"].dump() + "/" + want["n"].dump();
    expect_interval(wilson(*of), want["wilson95"], what + " wilson");
    expect_interval(wilson(*of, 0.99), want["wilson99"], what + " wilson 99");
    expect_interval(wilson(*of, 0.95, true), want["wilson_cc95"], what + " wilson cc");
    expect_interval(clopper_pearson(*of), want["clopper_pearson95"], what + " exact");
    expect_interval(agresti_coull(*of), want["agresti_coull95"], what + " agresti");
    expect_interval(jeffreys(*of), want["jeffreys95"], what + " jeffreys");
  }
}

TEST(Proportions, DifferenceAgreesWithNewcombeAndFisher) {
  const auto reference = golden::expected("proportions");
  for (const auto& want : reference["difference"]) {
    const Proportion a{want["x1"], want["n1"]}, b{want["x2"], want["n2"]};
    expect_interval(newcombe_difference(a, b), want["newcombe95"], "newcombe");
    expect_near(fisher_exact(a, b), want["fisher_p"], 1e-12, "fisher");
  }
}

TEST(Proportions, RefuseWhatIsNoCount) {
  EXPECT_FALSE(Proportion::make(3, 2));
  EXPECT_FALSE(Proportion::make(0.5, 2));
  EXPECT_FALSE(Proportion::make(0, 0));
}

void expect_detection(const core::Result<SignalDetection>& got, const core::Json& want,
                      const std::string& what) {
  ASSERT_TRUE(got) << what;
  expect_near(got->hit_rate, want["hit_rate"], 1e-12, what);
  expect_near(got->false_alarm_rate, want["fa_rate"], 1e-12, what);
  // Sums of two z of order 1, which may cancel: 1e-12 of a z.
  EXPECT_NEAR(got->d_prime, want["d_prime"].get<double>(), 1e-12) << what;
  EXPECT_NEAR(got->criterion, want["criterion_c"].get<double>(), 1e-12) << what;
  expect_near(got->beta, want["beta"], 1e-12, what + " beta");
  EXPECT_NEAR(got->ln_beta, want["ln_beta"].get<double>(), 1e-12) << what;
  expect_near(got->a_prime, want["A_prime"], 1e-12, what + " A'");
  expect_near(got->auc, want["auc_equal_var"], 1e-12, what + " auc");
  expect_near(got->variance, want["var_d_GourevitchGalanter"], 1e-12, what + " var");
  EXPECT_NEAR(got->d_prime_95.low, want["ci95"][0].get<double>(), 1e-12) << what;
  EXPECT_NEAR(got->d_prime_95.high, want["ci95"][1].get<double>(), 1e-12) << what;
}

TEST(SignalDetection, AgreesForEverySurgeonAndPooled) {
  const auto reference = golden::expected("sdt");
  double sum = 0.0;
  for (const auto& one : reference["per_surgeon"]) {
    const Proportion hits{one["hits"], one["n_signal"]};
    const Proportion alarms{one["false_alarms"], one["n_noise"]};
    const auto got = signal_detection(hits, alarms);
    expect_detection(got, one["loglinear"], one["surgeon"].dump());
    sum += got->d_prime;
    expect_detection(signal_detection(hits, alarms, RateCorrection::extremes),
                     one["extreme_replace"], one["surgeon"].dump() + " extremes");
  }
  expect_near(sum / 10.0, reference["mean_dprime_loglinear"], 1e-12, "mean");
  expect_detection(signal_detection({51, 60}, {14, 60}, RateCorrection::none),
                   reference["pooled_none"], "pooled");
  expect_detection(signal_detection({51, 60}, {14, 60}), reference["pooled_loglinear"], "pooled");
  EXPECT_FALSE(signal_detection({6, 6}, {0, 6}, RateCorrection::none));
}

TEST(ConfusionMatrix, AgreesWithRToTwelveDigits) {
  const auto reference = golden::expected("confusion_kappa");
  for (const char* name : {"sim", "example3"}) {
    const auto& want = reference[name];
    const auto got = confusion(golden::matrix_of(want["matrix"]));
    ASSERT_TRUE(got);
    expect_near(got->accuracy, want["accuracy"], 1e-12, name);
    expect_near(got->kappa, want["kappa"], 1e-12, name);
    expect_near(got->kappa_se, want["se_kappa"], 1e-12, name);
    expect_near(got->kappa_se_null, want["se_kappa_null"], 1e-12, name);
    expect_interval(got->kappa_95, want["ci95"], name);
    expect_interval(got->accuracy_95, want["accuracy_clopper_pearson95"], name);
    expect_near(got->kappa_linear, want["kappa_linear_weighted"], 1e-12, name);
    expect_near(got->kappa_quadratic, want["kappa_quadratic_weighted"], 1e-12, name);
    expect_near(got->precision, want["precision"], 1e-12, name);
    expect_near(got->recall, want["recall"], 1e-12, name);
    expect_near(got->specificity, want["specificity"], 1e-12, name);
    expect_near(got->f1, want["f1"], 1e-12, name);
    expect_near(got->macro_precision, want["macro_precision"], 1e-12, name);
    expect_near(got->balanced_accuracy, want["macro_recall_balanced_accuracy"], 1e-12, name);
    expect_near(got->macro_f1, want["macro_f1"], 1e-12, name);
    expect_near(got->weighted_f1, want["weighted_f1"], 1e-12, name);
    expect_near(got->mcc, want["mcc_multiclass_RK"], 1e-12, name);
    expect_near(got->p_above_no_information, want["p_acc_gt_nir"], 1e-12, name);
    expect_near(got->mutual_information_bits, want["mutual_information_bits"], 1e-12, name);
    if (want.contains("bowker_symmetry_chi2"))
      expect_near(got->bowker, want["bowker_symmetry_chi2"], 1e-12, name);
  }
}

TEST(ConfusionMatrix, GivesAClassNeverSaidAPrecisionOfZero) {
  const auto reference = golden::expected("confusion_kappa");
  const auto got = confusion(golden::matrix_of(reference["empty_class"]["matrix"]));
  ASSERT_TRUE(got);
  expect_near(got->kappa, reference["empty_class"]["kappa"], 1e-12, "kappa");
  EXPECT_EQ(got->precision[2], 0.0);
  EXPECT_EQ(got->f1[2], 0.0);
  EXPECT_FALSE(confusion(Matrix::Zero(2, 2)));
}

TEST(BinomialTest, CountsOutcomesNoLikelierThanTheObserved) {
  // By hand, 9 of 10 at one half: P(0, 1, 9, 10) = (1 + 10 + 10 + 1)/1024.
  EXPECT_NEAR(binomial_test(*Proportion::make(9, 10), 0.5), 22.0 / 1024.0, 1e-15);
  // 0 of 3 at 1/4: 27/64 is the likeliest but one; 1 of 3 has 27/64 as well, so all but it: 1.
  EXPECT_NEAR(binomial_test(*Proportion::make(0, 3), 0.25), 1.0, 1e-12);
  // 3 of 3 at 1/4: only 1/64.
  EXPECT_NEAR(binomial_test(*Proportion::make(3, 3), 0.25), 1.0 / 64.0, 1e-15);
  EXPECT_EQ(binomial_test(*Proportion::make(3, 3), 1.0), 1.0);
  EXPECT_EQ(binomial_test(*Proportion::make(2, 3), 1.0), 0.0);
}

TEST(Adjustments, AgreeWithRInEveryCase) {
  const auto reference = golden::expected("p_adjust");
  const std::vector<std::pair<const char*, Adjustment>> all = {
      {"holm", Adjustment::holm},
      {"hochberg", Adjustment::hochberg},
      {"hommel", Adjustment::hommel},
      {"bonferroni", Adjustment::bonferroni},
      {"BH", Adjustment::benjamini_hochberg},
      {"BY", Adjustment::benjamini_yekutieli}};
  for (const auto& [name, want] : reference.items())
    for (const auto& [key, how] : all) {
      const auto got = adjusted(want["p"].get<std::vector<double>>(), how);
      for (std::size_t i = 0; i < got.size(); ++i)
        expect_near(got[i], want[key][i], 1e-14, name + std::string(" ") + key);
    }
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
