/// Effect sizes, reliability, cumulative sums and exact permutation against R and exact counts.
#include "statistics/agreement/icc.hpp"
#include "statistics/golden_test.hpp"
#include "statistics/learning/cusum.hpp"
#include "statistics/ranks/permutation.hpp"
#include "statistics/summary/effect_size.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;
using golden::vector_of;

void expect_interval(const Interval& got, const core::Json& want, double tolerance,
                     const std::string& what) {
  expect_near(got.low, want[0], tolerance, what + " low");
  expect_near(got.high, want[1], tolerance, what + " high");
}

TEST(EffectSize, TwoSamplesAgreeWithR) {
  const auto reference = golden::expected("effect_sizes");
  const auto& want = reference["two_sample"];
  const Vector x = vector_of(want["x"]), y = vector_of(want["y"]);
  const auto got = two_samples(x, y);
  ASSERT_TRUE(got);
  expect_near(got->t, want["t"], 1e-12, "t");
  expect_near(got->p, want["p"], 1e-11, "p");
  expect_interval(got->difference_95, want["ci95"], 1e-11, "ci");
  expect_near(got->d, want["cohen_d"], 1e-12, "d");
  expect_near(hedges_j(13.0), want["hedges_J_exact"], 1e-12, "J");
  expect_near(got->g, want["hedges_g_exact"], 1e-12, "g");
  expect_interval(got->d_95, want["d_ci95_noncentral_t"], 1e-9, "d ci");
  expect_near(got->d_other, want["glass_delta_y"], 1e-12, "glass");
  const auto unequal = welch_t(x, y);
  ASSERT_TRUE(unequal);
  expect_near(unequal->t, want["welch"]["t"], 1e-12, "welch t");
  expect_near(unequal->df, want["welch"]["df"], 1e-12, "welch df");
  expect_near(unequal->p, want["welch"]["p"], 1e-11, "welch p");
  expect_interval(unequal->difference_95, want["welch"]["ci95"], 1e-10, "welch ci");
}

TEST(EffectSize, PairsAgreeWithR) {
  const auto reference = golden::expected("effect_sizes");
  const auto& want = reference["paired"];
  const auto got = paired(vector_of(want["x"]), vector_of(want["y"]));
  ASSERT_TRUE(got);
  expect_near(got->t, want["t"], 1e-12, "t");
  expect_near(got->d, want["d_z"], 1e-12, "d_z");
  expect_near(got->d_other, want["d_av"], 1e-12, "d_av");
  expect_near(got->g, want["g_z_exact"], 1e-12, "g_z");
  expect_interval(got->d_95, want["d_z_ci95_noncentral_t"], 1e-9, "d ci");
  EXPECT_FALSE(paired(Vector::Ones(3), Vector::Zero(3)));
  EXPECT_FALSE(two_samples(Vector::Ones(1), Vector::Zero(3)));
}

TEST(Icc, AgreesWithShroutAndFleissAndR) {
  const auto reference = golden::expected("icc");
  for (const auto& [name, want] : reference.items()) {
    const golden::Csv csv(want["data"]);
    const auto got = icc(csv.numeric_from(name == "shrout_fleiss" ? 0 : 1));
    ASSERT_TRUE(got) << name;
    expect_near(got->ms_rows, want["MSR"], 1e-11, name);
    expect_near(got->ms_error, want["MSE"], 1e-11, name);
    expect_near(got->icc1, want["ICC1"], 1e-11, name);
    expect_near(got->icc2, want["ICC2"], 1e-11, name);
    expect_near(got->icc3, want["ICC3"], 1e-11, name);
    expect_near(got->icc1k, want["ICC1k"], 1e-11, name);
    expect_near(got->icc2k, want["ICC2k"], 1e-11, name);
    expect_near(got->icc3k, want["ICC3k"], 1e-11, name);
    expect_near(got->p1, want["F1_p"], 1e-11, name);
    expect_near(got->p23, want["F23_p"], 1e-11, name);
    expect_interval(got->icc1_95, want["ci95_ICC1"], 1e-11, name + " 1");
    expect_interval(got->icc2_95, want["ci95_ICC2"], 1e-11, name + " 2");
    expect_interval(got->icc3_95, want["ci95_ICC3"], 1e-11, name + " 3");
    expect_near(got->sem_agreement, want["SEM_agreement"], 1e-11, name);
    expect_near(got->mdc95_consistency, want["MDC95_consistency"], 1e-11, name);
  }
  EXPECT_FALSE(icc(Matrix::Ones(1, 3)));
  EXPECT_FALSE(icc(Matrix::Ones(3, 3)));
}

TEST(Cusum, PathsAndExactProbabilitiesAgree) {
  const auto want = golden::expected("cusum");
  std::vector<bool> failures;
  for (const auto& one : want["failure_sequence"]) failures.push_back(one.get<int>() == 1);
  const auto rates = Rates::make(want["p_adequate"], want["p_inadequate"]);
  ASSERT_TRUE(rates);
  const auto up = lc_cusum(failures, *rates), down = deterioration_cusum(failures, *rates);
  for (std::size_t t = 0; t < failures.size(); ++t) {
    EXPECT_NEAR(up[t], want["lc_cusum"]["S"][t].get<double>(), 1e-12);
    EXPECT_NEAR(down[t], want["cusum_deterioration"]["S"][t].get<double>(), 1e-12);
  }
  for (const auto& [name, one] : want["exact_signal_probabilities_lc_cusum"].items()) {
    double h = 0.0, failure = 0.0;
    ASSERT_EQ(std::sscanf(name.c_str(), "h=%lf,p_fail=%lf", &h, &failure), 2);
    const auto got = lc_cusum_characteristic(*rates, h, failure, 60);
    for (const std::size_t by : {12u, 20u, 40u, 60u})
      expect_near(got.signalled_by[by - 1], one["P_signal_by_" + std::to_string(by)], 1e-12, name);
    expect_near(got.mean_run_length, one["mean_run_length_truncated_60"], 1e-12, name);
  }
  EXPECT_FALSE(Rates::make(0.3, 0.2));
}

TEST(Permutation, CountsEveryArrangementOfThePapersTables) {
  const auto reference = golden::expected("permutation_slope_exact");
  for (const auto& [name, want] : reference.items()) {
    const auto got = permutation_slope(vector_of(want["x"]), vector_of(want["y"]));
    ASSERT_TRUE(got) << name;
    EXPECT_EQ(got->arrangements, want["distinct_permutations"].get<std::uint64_t>()) << name;
    EXPECT_EQ(got->as_extreme, want["count_abs_ge"].get<std::uint64_t>()) << name;
    expect_near(got->p_greater, want["p_one_sided_greater"], 1e-15, name);
    expect_near(got->p_less, want["p_one_sided_less"], 1e-15, name);
  }
}

TEST(Permutation, SignFlipsAreCountedAndTooManyRefused) {
  const auto reference = golden::expected("nonparametric");
  const auto& want = reference["sign_flip_exact"];
  const auto got = sign_flip(vector_of(want["diffs"]));
  ASSERT_TRUE(got);
  EXPECT_EQ(got->as_extreme, want["count"].get<std::uint64_t>());
  EXPECT_EQ(got->flips, want["total"].get<std::uint64_t>());
  EXPECT_FALSE(sign_flip(Vector::LinSpaced(29, 1.0, 2.0)));
  EXPECT_FALSE(permutation_slope(Vector::LinSpaced(20, 0.0, 1.0), Vector::LinSpaced(20, 0.0, 1.0)));
}

TEST(Sprt, FollowsTheReferencesSumsAndBounds) {
  const auto want = golden::expected("cusum");
  const auto& test = want["sprt_unrestricted"];
  std::vector<bool> failures;
  for (const auto& one : want["failure_sequence"]) failures.push_back(one.get<int>() == 1);
  const auto rates = Rates::make(want["p_adequate"], want["p_inadequate"]);
  ASSERT_TRUE(rates);
  const auto bounds = sprt_bounds(test["alpha"], test["beta"]);
  EXPECT_NEAR(bounds.upper, test["wald_upper_ln((1-beta)/alpha)"].get<double>(), 1e-12);
  EXPECT_NEAR(bounds.lower, test["wald_lower_ln(beta/(1-alpha))"].get<double>(), 1e-12);
  const auto got = sprt(failures, *rates, bounds);
  for (std::size_t t = 0; t < failures.size(); ++t)
    EXPECT_NEAR(got.sums[t], test["S"][t].get<double>(), 1e-12);
  // 3.1182 at trial 7 is the first of the reference's sums beyond 2.7726.
  EXPECT_EQ(got.verdict, Sprt::Verdict::inadequate);
  EXPECT_EQ(got.decided_at, 7u);
}

TEST(Sprt, ItsCharacteristicIsThatOfPathsCountedByHand) {
  // A failure is worth 0.9163, a success −0.1823; the bounds are 2.7726 and −1.5581. Four failures
  // in four trials decide; in five, four failures of which one success came among the first four;
  // nine successes in a row decide the other way.
  const auto rates = Rates::make(0.10, 0.25);
  const auto bounds = sprt_bounds(0.05, 0.20);
  const double p = 0.3, q = 0.7;
  const auto three = sprt_characteristic(*rates, bounds, p, 3);
  EXPECT_EQ(three.adequate + three.inadequate, 0.0);
  EXPECT_NEAR(three.mean_trials, 3.0, 1e-14);
  const auto five = sprt_characteristic(*rates, bounds, p, 5);
  EXPECT_NEAR(five.inadequate, std::pow(p, 4) * (1.0 + 4.0 * q), 1e-15);
  EXPECT_NEAR(five.mean_trials, 5.0 - std::pow(p, 4), 1e-14);
  EXPECT_EQ(sprt_characteristic(*rates, bounds, p, 8).adequate, 0.0);
  EXPECT_NEAR(sprt_characteristic(*rates, bounds, p, 9).adequate, std::pow(q, 9), 1e-15);
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
