/// Power, normality, ranks and learning curves against R and 50-digit values.
#include "statistics/golden_test.hpp"
#include "statistics/learning/learning_curve.hpp"
#include "statistics/ranks/rank_tests.hpp"
#include "statistics/summary/effect_size.hpp"
#include "statistics/summary/power.hpp"
#include "statistics/summary/shapiro_wilk.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;
using golden::vector_of;

struct PowerReference : testing::Test {
  core::Json want = golden::expected("power");
  void expect_power(const char* name, double got) {
    expect_near(got, want[name]["power"], 1e-8, name);
  }
  /// R finds n to 1e-6 only.
  void expect_size(const char* name, const std::function<double(double)>& power_of) {
    const auto n = needed_size(power_of, want[name]["power"], 4.0);
    ASSERT_TRUE(n) << name;
    expect_near(*n, want[name]["n"], 2e-6, name);
    if (!want[name].contains("n_ceil")) return;
    EXPECT_EQ(std::ceil(*n), want[name]["n_ceil"].get<double>()) << name;
  }
};

TEST_F(PowerReference, PowerAgreesWithR) {
  const double r = want["r_paper_table3_n10"]["r"];
  expect_power("t_two_sample_d0.5_n20", power_two_samples(0.5, 20));
  expect_power("t_paired_d0.8_n10", power_paired(0.8, 10));
  expect_power("r_paper_table3_n10", power_correlation(r, 10));
  expect_power("anova_k3_f0.25_n10", power_one_way(0.25, 3, 10));
  expect_power("regression_slope_paper_table3",
               power_regression(want["regression_slope_paper_table3"]["f2"], 1, 8));
  expect_power("one_prop", power_one_proportion(want["one_prop"]["h"], 60));
  for (const char* name : {"n10_f0.25_rho0.5", "n10_f0.40_rho0.5_eps0.75"}) {
    const auto& one = want["rm_within_GPower"][name];
    expect_near(power_repeated({one["f"], one["m"], one["rho"], one["eps"]}, one["n"]),
                one["power"], 1e-8, name);
  }
}

TEST_F(PowerReference, NeededSizesAgreeWithR) {
  const double r = want["r_n_for_.8_r0.3065"]["r"];
  const double h = want["two_prop_.85_vs_.70"]["h"];
  expect_size("t_two_sample_n_for_.8_d0.5", [](double n) { return power_two_samples(0.5, n); });
  expect_size("t_two_sample_n_for_.9_d0.8", [](double n) { return power_two_samples(0.8, n); });
  expect_size("t_paired_n_for_.8_d0.5", [](double n) { return power_paired(0.5, n); });
  expect_size("r_n_for_.8_r0.3065", [&](double n) { return power_correlation(r, n); });
  expect_size("r_n_for_.8_r0.5", [](double n) { return power_correlation(0.5, n); });
  expect_size("anova_k3_n_for_.8_f0.25", [](double n) { return power_one_way(0.25, 3, n); });
  expect_size("anova_k3_n_for_.8_f0.4", [](double n) { return power_one_way(0.4, 3, n); });
  expect_size("two_prop_.85_vs_.70", [&](double n) { return power_two_proportions(h, n); });
  EXPECT_FALSE(needed_size([](double) { return 0.05; }, 0.8, 4.0));
}

TEST_F(PowerReference, SurgeonsNeededForThreeTrialsAgreeWithGPower) {
  const auto people = [](RepeatedDesign design) {
    const auto n = needed_size([&](double m) { return power_repeated(design, m); }, 0.8, 3.0);
    return n ? std::ceil(*n) : 0.0;
  };
  const auto& rm = want["rm_within_GPower"];
  EXPECT_EQ(people({0.25, 3, 0.5, 1.0}), rm["n_required_f0.25_rho0.5"].get<double>());
  EXPECT_EQ(people({0.25, 3, 0.5, 0.75}), rm["n_required_f0.25_rho0.5_eps0.75"].get<double>());
  EXPECT_EQ(people({0.40, 3, 0.5, 1.0}), rm["n_required_f0.40_rho0.5"].get<double>());
}

TEST(ShapiroWilkTest, AgreesWithRFrom3To5000Values) {
  const auto reference = golden::expected("shapiro");
  for (const auto& [name, want] : reference.items()) {
    const auto got = shapiro_wilk(vector_of(want["x"]));
    ASSERT_TRUE(got) << name;
    expect_near(got->w, want["W"], 1e-10, name + " W");
    expect_near(got->p, want["p_value"], 1e-7, name + " p");
  }
  EXPECT_FALSE(shapiro_wilk(Vector::Ones(5)));
  EXPECT_FALSE(shapiro_wilk(Vector::LinSpaced(2, 0.0, 1.0)));
}

Groups groups_of(const core::Json& lists) {
  Groups out;
  for (const auto& list : lists) {
    out.names.push_back(std::to_string(out.names.size() + 1));
    out.values.push_back(vector_of(list));
  }
  return out;
}

TEST(Ranks, KruskalWallisAndFlignerAgreeWithR) {
  const auto small = golden::expected("nonparametric");
  for (const char* name : {"kruskal_hollander_wolfe", "kruskal_ties"}) {
    const auto got = kruskal_wallis(groups_of(small[name]["groups"]));
    ASSERT_TRUE(got);
    expect_near(got->h, small[name]["H"], 1e-12, name);
    expect_near(got->p, small[name]["p_chi2"], 1e-12, name);
  }
  const auto reference = golden::expected("anova_oneway");
  const auto& want = reference["unbalanced"];
  const golden::Csv csv("data/sim_unbalanced_oneway.csv");
  const Groups groups = grouped(csv.texts("g"), csv.numbers("y"));
  const auto h = kruskal_wallis(groups);
  ASSERT_TRUE(h);
  expect_near(h->h, want["kruskal"]["H"], 1e-11, "H");
  expect_near(h->epsilon_squared, want["kruskal"]["epsilon2"], 1e-11, "epsilon2");
  const auto spread = fligner_killeen(groups);
  ASSERT_TRUE(spread);
  expect_near(spread->statistic, want["fligner"]["X2"], 1e-11, "fligner");
  expect_near(spread->p, want["fligner"]["p_value"], 1e-11, "fligner p");
}

TEST(Ranks, ExactKruskalWallisCountsEveryDealing) {
  const auto reference = golden::expected("nonparametric");
  const auto& want = reference["kruskal_ties"];
  const auto got = kruskal_wallis_exact(groups_of(want["groups"]));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->arrangements, want["exact_perm_total"].get<double>());
  EXPECT_EQ(got->as_extreme, want["exact_perm_count"].get<double>());
  Groups large{{"a", "b"}, {Vector::LinSpaced(20, 0, 1), Vector::LinSpaced(20, 2, 3)}};
  const auto refused = kruskal_wallis_exact(large);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::too_large);
}

TEST(Ranks, FriedmanAndPageAgreeWithR) {
  const auto reference = golden::expected("rm_anova");
  for (const auto& [name, want] : reference["cases"].items()) {
    if (!want.contains("friedman")) continue;
    const Matrix values = golden::Csv(want["data"]).numeric_from(1);
    const auto got = friedman(values);
    ASSERT_TRUE(got) << name;
    expect_near(got->chi_squared, want["friedman"]["chi2"], 1e-12, name);
    expect_near(got->p, want["friedman"]["p_value"], 1e-12, name);
    expect_near(got->kendall_w, want["friedman"]["kendall_W"], 1e-12, name);
    if (!want.contains("page_decreasing")) continue;
    const auto page = page_trend(-values);
    ASSERT_TRUE(page) << name;
    expect_near(page->l, want["page_decreasing"]["L"], 0.0, name);
    expect_near(page->z, want["page_decreasing"]["z"], 1e-12, name);
    expect_near(page->p_rising, want["page_decreasing"]["p_one_sided_increasing"], 1e-12, name);
  }
}

TEST(Ranks, ExactTestsOfTwoSamplesAgreeWithR) {
  const auto reference = golden::expected("nonparametric");
  const auto& signs = reference["wilcoxon_signed_rank_exact"];
  const auto v = wilcoxon_signed_rank(vector_of(signs["x"]) - vector_of(signs["y"]));
  ASSERT_TRUE(v);
  EXPECT_EQ(v->statistic, signs["V"].get<double>());
  expect_near(v->p, signs["p_two_sided"], 1e-12, "V");
  const auto& two = reference["mann_whitney_exact"];
  const auto w = mann_whitney(vector_of(two["x"]), vector_of(two["y"]));
  ASSERT_TRUE(w);
  EXPECT_EQ(w->w, two["W"].get<double>());
  expect_near(w->p, two["p_two_sided"], 1e-12, "W");
  expect_near(w->cliff_delta, two["cliff_delta"], 1e-12, "delta");
  EXPECT_FALSE(wilcoxon_signed_rank(Vector::Zero(4)));
}

TEST(Ranks, CorrelationsAgreeWithROnThePapersTables) {
  const auto reference = golden::expected("nonparametric");
  const golden::Csv csv("data/paper_table2_table4.csv");
  const Vector x = csv.numbers("experience_years");
  for (const auto& [table, column] :
       {std::pair{"table2", "wrong_breach"}, std::pair{"table4", "wrong_total"}}) {
    const auto& want = reference["correlations_paper"][table];
    const auto rho = spearman(x, csv.numbers(column)), tau = kendall(x, csv.numbers(column));
    ASSERT_TRUE(rho && tau);
    expect_near(rho->r, want["spearman_rho"], 1e-12, table);
    expect_near(rho->p, want["spearman_p_t_approx"], 1e-12, table);
    expect_near(tau->r, want["kendall_tau_b"], 1e-12, table);
    expect_near(tau->statistic, want["kendall_z"], 1e-12, table);
    expect_near(tau->p, want["kendall_p"], 1e-12, table);
  }
}

TEST(Ranks, ExactCorrelationsAgreeWithR) {
  const auto want = golden::expected("nonparametric")["spearman_exact_n9"];
  const Vector x = golden::vector_of(want["x"]), y = golden::vector_of(want["y"]);
  const auto rho = spearman(x, y), tau = kendall(x, y);
  ASSERT_TRUE(rho && rho->p_exact && tau && tau->p_exact);
  expect_near(rho->r, want["rho"], 1e-12, "rho");
  expect_near(*rho->p_exact, want["p"], 1e-12, "p");
  // T = 21 concordant of 36 pairs.
  EXPECT_NEAR(tau->r, (2.0 * want["kendall_T"].get<double>() - 36.0) / 36.0, 1e-12);
  expect_near(*tau->p_exact, want["kendall_p_exact"], 1e-12, "tau");
  // Two pairs of ties: 4!/(2! 2!) = 6 arrangements of 1 1 2 2 against 1 2 3 4, of which 1122 and
  // 2211 are as far from 0.
  const Vector four = Vector::LinSpaced(4, 1.0, 4.0);
  EXPECT_NEAR(*spearman(four, Eigen::Vector4d(1, 1, 2, 2))->p_exact, 2.0 / 6.0, 1e-15);
  EXPECT_FALSE(kendall(four, Eigen::Vector4d(1, 1, 2, 2))->p_exact);
  EXPECT_FALSE(spearman(Vector::LinSpaced(31, 0.0, 1.0), Vector::LinSpaced(31, 1.0, 0.0))->p_exact);
}

TEST(Ranks, KendallCountsManyPairsAsTheDefinitionDoes) {
  // Every value twice, in mixed order; against the definition's double sum.
  const auto made = [](Eigen::Index n) {
    Vector y(n);
    for (Eigen::Index i = 0; i < n; ++i) y[i] = static_cast<double>((i * 7919) % n / 2);
    return y;
  };
  const auto counted = [](const Vector& x, const Vector& y) {
    double s = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      for (Eigen::Index j = 0; j < i; ++j)
        s += double((x[i] > x[j]) - (x[i] < x[j])) * double((y[i] > y[j]) - (y[i] < y[j]));
    return s;
  };
  Vector x = made(400).reverse(), y = made(400);
  const double pairs = 400.0 * 399.0, tied = 400.0;  // 200 pairs of ties, counted twice
  EXPECT_NEAR(kendall(x, y)->r, 2.0 * counted(x, y) / (pairs - tied), 1e-12);
  const Vector large = Vector::LinSpaced(100'000, 0.0, 1.0);
  EXPECT_EQ(kendall(large, large)->r, 1.0);
  EXPECT_EQ(kendall(large, -large)->r, -1.0);
}

TEST(Correlation, PearsonAgreesWithROnThePapersTables) {
  const auto reference = golden::expected("nonparametric");
  const golden::Csv csv("data/paper_table2_table4.csv");
  for (const auto& [table, column] :
       {std::pair{"table2", "wrong_breach"}, std::pair{"table4", "wrong_total"}}) {
    const auto& want = reference["correlations_paper"][table];
    const auto r = pearson(csv.numbers("experience_years"), csv.numbers(column));
    ASSERT_TRUE(r);
    expect_near(r->r, want["pearson_r"], 1e-12, table);
    expect_near(r->t, want["pearson_t"], 1e-12, table);
    expect_near(r->p, want["pearson_p"], 1e-12, table);
    expect_near(r->r_95.low, want["pearson_fisher_ci95"][0], 1e-12, table);
    expect_near(r->r_95.high, want["pearson_fisher_ci95"][1], 1e-12, table);
  }
  EXPECT_FALSE(pearson(Vector::Ones(5), Vector::LinSpaced(5, 0.0, 1.0)));
}

TEST(Learning, CurvesReachTheFiftyDigitOptimum) {
  const auto reference = golden::expected("learning_curve");
  const golden::Csv csv(reference["data"]);
  const Vector n = csv.numbers("trial"), y = csv.numbers("time_s");
  for (const auto& [key, shape] :
       {std::pair{"power2_y=a*n^-b", CurveShape::power},
        std::pair{"power3_y=a*n^-b+c", CurveShape::power_plateau},
        std::pair{"exp3_y=a*exp(-b(n-1))+c", CurveShape::exponential_plateau}}) {
    const auto& want = reference[key];
    const auto fit = learning_curve(n, y, shape);
    ASSERT_TRUE(fit) << key;
    expect_near(fit->coefficients, want["coef"], 1e-8, key);
    expect_near(fit->standard_errors, want["se"], 1e-8, key);
    expect_near(fit->p, want["p_value"], 1e-8, key);
    expect_near(fit->rss, want["rss"], 1e-10, key);
    expect_near(fit->aic, want["AIC"], 1e-10, key);
    expect_near(fit->aicc, want["AICc"], 1e-10, key);
    expect_near(fit->bic, want["BIC"], 1e-10, key);
    if (shape == CurveShape::power)
      expect_near(100.0 * share_per_doubling(*fit),
                  reference["learning_rate_percent_per_doubling_from_power2"], 1e-8, key);
  }
}

TEST(Learning, SaysThatRisingOrFlatScoresAreNoCurve) {
  const Vector n = Vector::LinSpaced(10, 1.0, 10.0);
  EXPECT_FALSE(learning_curve(n, n, CurveShape::power));
  EXPECT_FALSE(learning_curve(n, Vector::Ones(10), CurveShape::power_plateau));
  EXPECT_FALSE(learning_curve(n.head(4), n.head(4), CurveShape::power));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
