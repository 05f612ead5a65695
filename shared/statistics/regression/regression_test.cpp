/// Least squares and its robust sibling against published tables and 50-digit values.
#include <cmath>

#include "statistics/golden_test.hpp"
#include "statistics/regression/bisquare.hpp"
#include "statistics/regression/ols.hpp"
#include "statistics/summary/modified_z.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;
using golden::vector_of;

void expect_fit(const Design& design, const Vector& y, const core::Json& want, double tolerance) {
  const auto fit = ols(design, y);
  ASSERT_TRUE(fit) << fit.error().what;
  expect_near(fit->coefficients, want["coef"], tolerance, "coef");
  expect_near(fit->standard_errors, want["se"], tolerance, "se");
  expect_near(fit->t, want["t"], tolerance, "t");
  expect_near(fit->p, want["p_value"], tolerance, "p");
  expect_near(fit->ci_low, want["ci95_lower"], tolerance, "ci_low");
  expect_near(fit->ci_high, want["ci95_upper"], tolerance, "ci_high");
  expect_near(fit->sigma, want["sigma"], tolerance, "sigma");
  expect_near(fit->r_squared, want["r2"], tolerance, "r2");
  expect_near(fit->adjusted_r_squared, want["adj_r2"], tolerance, "adj_r2");
  expect_near(fit->f, want["F"], tolerance, "F");
  expect_near(fit->f_p, want["F_p"], tolerance, "F_p");
  expect_near(fit->rss, want["rss"], tolerance, "rss");
  expect_near(fit->log_likelihood, want["logLik"], tolerance, "logLik");
  expect_near(fit->aic, want["AIC"], tolerance, "AIC");
  expect_near(fit->bic, want["BIC"], tolerance, "BIC");
  expect_near(fit->leverage, want["hat"], tolerance, "hat");
  expect_near(fit->residuals, want["resid"], tolerance, "resid");
  const auto parts = influence(*fit);
  expect_near(parts.cooks_distance, want["cooks_distance"], tolerance, "cook");
  expect_near(parts.standardised, want["rstandard"], tolerance, "rstandard");
  expect_near(parts.studentised, want["rstudent"], tolerance, "rstudent");
  expect_near(parts.dffits, want["dffits"], tolerance, "dffits");
  expect_near(hc3_standard_errors(design, *fit), want["hc3_se"], tolerance, "hc3");
}

struct PaperTables {
  golden::Csv csv{"data/paper_table2_table4.csv"};
  Design design = with_intercept(csv.numbers("experience_years"), {"experience_years"});
  core::Json want = golden::expected("ols_paper_tables3_5");
};

TEST(Ols, GivesEveryDigitOfThePapersTables3And5) {
  const PaperTables paper;
  expect_fit(paper.design, paper.csv.numbers("wrong_breach"), paper.want["table3"], 1e-12);
  expect_fit(paper.design, paper.csv.numbers("wrong_total"), paper.want["table5"], 1e-12);
}

TEST(Ols, AgreesWithAllSixteenPrintedNumbersOfThePaper) {
  const PaperTables paper;
  // The paper prints four digits, most of them truncated.
  for (const auto& [table, column] :
       {std::pair{"table3", "wrong_breach"}, std::pair{"table5", "wrong_total"}}) {
    const auto fit = ols(paper.design, paper.csv.numbers(column));
    ASSERT_TRUE(fit);
    const auto& printed = paper.want[table]["printed"];
    for (Eigen::Index j = 0; j < 2; ++j) {
      const auto at = static_cast<std::size_t>(j);
      EXPECT_LT(std::abs(fit->coefficients[j] - printed["coef"][at].get<double>()), 1e-4);
      EXPECT_LT(std::abs(fit->standard_errors[j] - printed["se"][at].get<double>()), 1e-4);
      EXPECT_LT(std::abs(fit->t[j] - printed["t"][at].get<double>()), 1e-4);
      EXPECT_LT(std::abs(fit->p[j] - printed["p_value"][at].get<double>()), 1e-4);
    }
  }
}

TEST(Ols, HoldsOnTheCollinearHaldCementData) {
  const golden::Csv csv("data/hald.csv");
  const Matrix all = csv.numeric_from(0);
  expect_fit(with_intercept(all.leftCols(4), {"x1", "x2", "x3", "x4"}), csv.numbers("heat"),
             golden::expected("ols_hald")["fit"], 1e-10);
}

TEST(Ols, HoldsOnCarsmall) {
  const golden::Csv csv("data/carsmall_93.csv");
  Matrix x(93, 3);
  x << csv.numbers("weight"), csv.numbers("horsepower"), csv.numbers("acceleration");
  expect_fit(with_intercept(x, {"weight", "horsepower", "acceleration"}), csv.numbers("mpg"),
             golden::expected("ols_carsmall")["fit"], 1e-11);
}

TEST(Ols, GivesTheSameLineForManyCopiesOfTheData) {
  // 15 000 copies of Table 2 pass the size up to which 80-bit arithmetic is used: the line stays,
  // the residual sum of squares is 15 000 times as large.
  const PaperTables paper;
  const auto& want = paper.want["table3"];
  const Eigen::Index copies = 15000;
  const Matrix x = paper.design.columns.col(1).replicate(copies, 1);
  const Vector y = paper.csv.numbers("wrong_breach").replicate(copies, 1);
  const auto fit = ols(with_intercept(x, {"years"}), y);
  ASSERT_TRUE(fit);
  expect_near(fit->coefficients, want["coef"], 1e-12, "coef");
  expect_near(fit->rss / static_cast<double>(copies), want["rss"], 1e-12, "rss");
  expect_near(fit->r_squared, want["r2"], 1e-11, "r2");
}

TEST(Ols, KeepsTwelveDigitsWhenXIsFarFromZero) {
  const core::Json reference = golden::expected("ols_hard_offset_exact");
  for (const auto& [name, want] : reference["cases"].items()) {
    const Vector x = vector_of(want["x_minus_offset"]).array() + want["x_offset"].get<double>();
    const auto fit = ols(with_intercept(x, {"x"}), vector_of(want["y"]));
    ASSERT_TRUE(fit) << name << ": " << fit.error().what;
    expect_near(fit->coefficients, want["coef"], 1e-12, name + " coef");
    expect_near(fit->standard_errors, want["se"], 1e-12, name + " se");
    expect_near(fit->rss, want["rss"], 1e-12, name + " rss");
    expect_near(fit->p[1], want["p_slope"], 1e-12, name + " p");
  }
}

TEST(Ols, NamesTheColumnsThatSayTheSameTwice) {
  Matrix x(6, 3);
  x << 1, 5, 7, 2, 4, 8, 3, 1, 7, 4, 0, 8, 5, 9, 19, 6, 2, 14;
  x.col(2) = 2.0 * x.col(0) + x.col(1);
  Vector y(6);
  y << 1, 3, 2, 5, 4, 7;
  const auto fit = ols(with_intercept(x, {"a", "b", "c"}), y);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().what.find("is a linear combination of"), std::string::npos)
      << fit.error().what;
  x.col(2).setConstant(0.1);
  const auto constant = ols(with_intercept(x, {"a", "b", "c"}), y);
  ASSERT_FALSE(constant);
  EXPECT_EQ(constant.error().what, "the columns are collinear: 'c' is constant");
}

TEST(Ols, RefusesWhatCannotBeAnswered) {
  const Vector x = Vector::LinSpaced(5, 0.0, 4.0);
  EXPECT_FALSE(ols(with_intercept(x, {"x"}), Vector::Constant(5, 3.0)));
  EXPECT_FALSE(ols(with_intercept(x.head(2), {"x"}), x.head(2)));
  Vector y = x.array().square();
  y[3] = std::numeric_limits<double>::quiet_NaN();
  const auto fit = ols(with_intercept(x, {"x"}), y);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().what, "the response in row 4 is not a finite number");
}

TEST(Ols, FollowsTheUnitOfTheDataUpTo1e140AndRefusesBeyondADouble) {
  const Vector x = Vector::LinSpaced(6, 0.0, 5.0);
  Vector y(6);
  y << 1, 3, 2, 5, 4, 7;
  const auto plain = ols(with_intercept(x, {"x"}), y);
  for (const double scale : {1e-140, 1e140}) {
    const auto fit = ols(with_intercept(x, {"x"}), y * scale);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->coefficients[1] / scale, plain->coefficients[1], 1e-12);
    EXPECT_NEAR(fit->p[1], plain->p[1], 1e-12 * plain->p[1]);
  }
  EXPECT_FALSE(ols(with_intercept(x, {"x"}), y * 1e300));
}

TEST(Bisquare, ReproducesAllFifteenCasesOfTheToolThePaperUsed) {
  const core::Json reference = golden::expected("robustfit_bisquare");
  std::size_t compared = 0;
  for (const auto& one : reference["cases"]) {
    const std::string id = one["id"];
    const auto& want = one["matlab"];
    const Matrix x = golden::matrix_of(one["X_including_constant"]);
    Design design{x, {}, true};
    for (Eigen::Index j = 0; j < x.cols(); ++j) design.names.push_back("x" + std::to_string(j));
    const auto fit = bisquare(design, vector_of(one["y"]),
                              {.tuning = one["tune"].get<double>(), .standard_error_floor = true});
    ASSERT_TRUE(fit) << id << ": " << fit.error().what;
    ++compared;
    expect_near(fit->coefficients, want["b"], 1e-9, id + " b");
    if (id.starts_with(
            "exact_")) {  // residuals are rounding alone: only b and the floor say anything
      for (const double se : fit->standard_errors) EXPECT_GE(se, 1.49e-8) << id;
      continue;
    }
    EXPECT_EQ(fit->iterations, want["iter"].get<int>()) << id;
    EXPECT_EQ(fit->converged, want["converged"].get<bool>()) << id;
    expect_near(fit->standard_errors, want["se"], 1e-9, id + " se");
    expect_near(fit->t, want["t"], 1e-9, id + " t");
    expect_near(fit->p, want["p"], 1e-9, id + " p");
    expect_near(fit->ols_sigma, want["ols_s"], 1e-9, id + " ols_s");
    expect_near(fit->mad_sigma, want["mad_s"], 1e-9, id + " mad_s");
    expect_near(fit->robust_sigma, want["robust_s"], 1e-9, id + " robust_s");
    expect_near(fit->sigma, want["s"], 1e-9, id + " s");
    expect_near(fit->leverage, want["h"], 1e-9, id + " h");
    expect_near(fit->ols_coefficients, want["b_ols"], 1e-9, id + " b_ols");
    expect_near(fit->studentised, want["rstud"], 1e-9, id + " rstud");
    EXPECT_EQ(fit->df_residual, want["dfe"].get<double>()) << id;
    const Matrix covariance = golden::matrix_of(want["covb"]);
    EXPECT_LT((fit->covariance - covariance).norm(), 1e-9 * covariance.norm()) << id;
    if (one["matlab_published"].is_object() && one["matlab_published"].contains("brob")) {
      const Vector printed = vector_of(one["matlab_published"]["brob"]);  // with four decimals
      EXPECT_LT((fit->coefficients - printed).cwiseAbs().maxCoeff(), 6e-5) << id;
    }
    const Vector w = vector_of(want["w"]);
    EXPECT_LT((fit->weights - w).cwiseAbs().maxCoeff(), 1e-9) << id;
  }
  EXPECT_EQ(compared, 15u);
}

/// Table 2 of the study, laid end to end `times` times.
std::pair<Design, Vector> repeated(Eigen::Index times) {
  const golden::Csv csv("data/paper_table2_table4.csv");
  const Vector x = csv.numbers("experience_years"), y = csv.numbers("wrong_breach");
  return {with_intercept(x.replicate(times, 1), {"x"}), y.replicate(times, 1)};
}

TEST(Ols, InBlocksGivesTheCoefficientsOfTheRowsItRepeats) {
  // k copies of a table have its coefficients and k times its residual sum of squares.
  const core::Json want = golden::expected("ols_paper_tables3_5")["table3"];
  constexpr Eigen::Index kTimes = 20'001;  // 400 020 numbers
  const auto [design, y] = repeated(kTimes);
  const auto fit = ols(design, y);
  ASSERT_TRUE(fit);
  expect_near(fit->coefficients, want["coef"], 1e-12, "coefficients");
  const auto [few, y_few] = repeated(1);
  const auto small = ols(few, y_few);
  const double n = 10.0 * double(kTimes);
  EXPECT_NEAR(fit->rss, small->rss * double(kTimes), 1e-10 * fit->rss);
  const double shrink = std::sqrt(8.0 / (n - 2.0));
  EXPECT_NEAR(fit->standard_errors[1], small->standard_errors[1] * shrink,
              1e-11 * fit->standard_errors[1]);
  EXPECT_NEAR(fit->leverage[0] * double(kTimes), small->leverage[0], 1e-11);
  EXPECT_NEAR(fit->residuals[10], small->residuals[0], 1e-11);
}

TEST(Ols, InBlocksStillNamesCollinearColumnsAndTakesNoIntercept) {
  auto [design, y] = repeated(20'001);
  Design twice = design;
  twice.columns.conservativeResize(Eigen::NoChange, 3);
  twice.columns.col(2) = 2.0 * design.columns.col(1);
  twice.names.push_back("double");
  const auto refused = ols(twice, y);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("linear combination"), std::string::npos);
  const Vector x = design.columns.col(1);
  Design wide{Matrix(x.size(), 2), {"x", "x2"}, false};
  wide.columns << x, x.cwiseAbs2();
  const auto fit = ols(wide, y);
  ASSERT_TRUE(fit);
  const Vector residual = y - wide.columns * fit->coefficients;
  EXPECT_LT((wide.columns.transpose() * residual).cwiseAbs().maxCoeff(), 1e-6);  // normal equations
}

TEST(Ols, InBlocksDoesNotCareWhichRowsItGuessesTheMeansFrom) {
  // Means are first guessed from every n/64th row. Here those lie far from all others; turned by
  // one row, they do not.
  constexpr Eigen::Index kRows = 128'000;
  Matrix x(kRows, 2);
  Vector y(kRows);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = static_cast<double>(i);
    x(i, 0) = 1e4 + std::sin(12.9898 * t) + (i % (kRows / 64) == 0 ? 1e4 : 0.0);
    x(i, 1) = 1e-6 * (t + std::sin(78.233 * t));
    y[i] = 2.0 * x(i, 0) - 3e6 * x(i, 1) + std::sin(43758.5453 * t);
  }
  const auto turned = [](const auto& of) {
    auto out = of;
    out.topRows(kRows - 1) = of.bottomRows(kRows - 1);
    out.row(kRows - 1) = of.row(0);
    return out;
  };
  const auto a = ols(with_intercept(x, {"a", "b"}), y);
  const auto b = ols(with_intercept(turned(x), {"a", "b"}), turned(y));
  ASSERT_TRUE(a && b);
  for (Eigen::Index j = 0; j < 3; ++j) {
    // A last digit of the coefficient, or nothing beside what it is known to.
    EXPECT_NEAR(a->coefficients[j], b->coefficients[j],
                std::max(1e-14 * std::abs(b->coefficients[j]), 1e-8 * b->standard_errors[j]));
    EXPECT_NEAR(a->standard_errors[j], b->standard_errors[j], 1e-9 * b->standard_errors[j]);
  }
  EXPECT_NEAR(a->coefficients[1], 2.0, 1e-3);
}

TEST(Ols, InBlocksNamesTheRowThatIsNoNumberAndTheResponseThatIsConstant) {
  auto [design, y] = repeated(20'001);
  Vector holed = y;
  holed[150'000] = std::nan("");
  EXPECT_EQ(ols(design, holed).error().what, "the response in row 150001 is not a finite number");
  EXPECT_FALSE(ols(design, Vector::Constant(y.size(), 0.1)));
  Design hole = design;
  hole.columns(7, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ols(hole, y).error().what, "column 'x', row 8: not a finite number");
}

TEST(Bisquare, FollowsRsMassWhereAsked) {
  const core::Json reference = golden::expected("robustfit_bisquare");
  int compared = 0;
  for (const auto& one : reference["cases"]) {
    const std::string id = one["id"];
    // With tiny_ y, R's stop rule has an absolute floor of 1e-10 that ours leaves out.
    if (id.starts_with("exact_") || id.starts_with("tiny_")) continue;
    if (!one["contrast"].contains("MASS_rlm_default")) continue;
    const auto& want = one["contrast"]["MASS_rlm_default"];
    if (!want.contains("coef") || want["coef"].is_null()) continue;
    const Matrix x = golden::matrix_of(one["X_including_constant"]);
    Design design{x, {}, true};
    for (Eigen::Index j = 0; j < x.cols(); ++j) design.names.push_back("x" + std::to_string(j));
    const auto fit =
        bisquare(design, vector_of(one["y"]),
                 {.convention = BisquareConvention::mass, .tuning = one["tune"].get<double>()});
    ASSERT_TRUE(fit) << id;
    ++compared;
    expect_near(fit->coefficients, want["coef"], 1e-9, id + " b");
    expect_near(fit->standard_errors, want["se"], 1e-9, id + " se");
    expect_near(fit->mad_sigma, want["scale"], 1e-9, id + " scale");
  }
  EXPECT_GE(compared, 5);
}

TEST(ModifiedZ, MatchesTheReferenceIncludingItsFallback) {
  const core::Json reference = golden::expected("modified_z");
  for (const auto& [name, want] : reference["cases"].items()) {
    const ModifiedZ got = modified_z(vector_of(want["x"]));
    expect_near(got.median, want["median"], 1e-13, name);
    expect_near(got.mad, want["MAD"], 1e-13, name);
    expect_near(got.mean_deviation, want["mean_abs_dev"], 1e-13, name);
    expect_near(got.z, want["z"], 1e-13, name);
    EXPECT_EQ(got.by_mean_deviation, want["fallback_used"].get<bool>()) << name;
  }
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
