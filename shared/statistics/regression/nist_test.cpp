/// The certified NIST StRD problems, scored in correct digits (log relative error, at most 15).
#include <cmath>
#include <cstdio>

#include "statistics/anova/anova.hpp"
#include "statistics/golden_test.hpp"
#include "statistics/regression/ols.hpp"
#include "statistics/summary/summary.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::digits;
using golden::nist_line;
using golden::nist_rows;

struct Linear {
  const char* name;
  std::size_t first_row;
  int powers;  ///< y on x, x², … up to this power; 0: y on the columns as they are
  bool intercept;
  double least;  ///< digits that coefficients and standard errors must have
};

// The design is handed over in double: a power of x rounded to 16 digits is already another
// problem, which bounds Filip (condition 1e10 after scaling). Wampler4 and 5 bury the polynomial
// under residuals 10² and 10⁴ times larger, at the cost of as many digits.
const std::vector<Linear> kLinear = {
    {"Norris", 61, 1, true, 12.0},   {"Pontius", 61, 2, true, 11.0},
    {"NoInt1", 61, 1, false, 14.0},  {"NoInt2", 61, 1, false, 14.0},
    {"Filip", 61, 10, true, 7.0},    {"Longley", 61, 0, true, 12.0},
    {"Wampler1", 61, 5, true, 12.0}, {"Wampler2", 61, 5, true, 12.0},
    {"Wampler3", 61, 5, true, 12.0}, {"Wampler4", 61, 5, true, 11.0},
    {"Wampler5", 61, 5, true, 9.0}};

struct Problem {
  Design design;
  Vector y;
};

Problem problem_of(const Linear& which, const std::string& path) {
  const auto rows = nist_rows(path, which.first_row, 1000);
  const auto n = static_cast<Eigen::Index>(rows.size());
  const auto k = which.powers > 0 ? which.powers : static_cast<Eigen::Index>(rows[0].size()) - 1;
  Matrix x(n, k);
  Vector y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    y[i] = row[0];
    for (Eigen::Index j = 0; j < k; ++j)
      x(i, j) = which.powers > 0 ? std::pow(row[1], static_cast<double>(j + 1))
                                 : row[static_cast<std::size_t>(j) + 1];
  }
  std::vector<std::string> names;
  for (Eigen::Index j = 0; j < k; ++j) names.push_back("B" + std::to_string(j + 1));
  if (which.intercept) return {with_intercept(x, names), y};
  return {{x, names, false}, y};
}

TEST(Nist, LinearRegressionHasTheCertifiedDigits) {
  std::printf("%-10s %12s %12s %12s\n", "linear", "coefficients", "std. errors", "residual sd");
  for (const auto& which : kLinear) {
    const std::string path = "nist/linear/" + std::string(which.name) + ".dat";
    const Problem problem = problem_of(which, path);
    const auto fit = ols(problem.design, problem.y);
    ASSERT_TRUE(fit) << which.name << ": " << fit.error().what;
    double coefficients = 15.0, errors = 15.0;
    for (Eigen::Index j = 0; j < fit->coefficients.size(); ++j) {
      const auto want = nist_line(path, " B" + std::to_string(which.intercept ? j : j + 1) + " ");
      ASSERT_GE(want.size(), 2u) << which.name;
      coefficients = std::min(coefficients, digits(fit->coefficients[j], want[0]));
      errors = std::min(errors, digits(fit->standard_errors[j], want[1]));
    }
    const double sd = digits(fit->sigma, nist_line(path, "Standard Deviation  ")[0]);
    std::printf("%-10s %12.1f %12.1f %12.1f\n", which.name, coefficients, errors, sd);
    EXPECT_GE(coefficients, which.least) << which.name;
    EXPECT_GE(errors, which.least) << which.name;
  }
}

TEST(Nist, AnovaHasTheCertifiedDigitsThatDoublesCanHold) {
  // Reading 1000000000000.4 as a double leaves 4 digits of the deviations: 4.4 digits of F are the
  // best possible for SmLs07 to SmLs09, and 10.2 for SmLs04 to SmLs06.
  const std::vector<std::pair<const char*, double>> problems = {
      {"SiRstv", 12.0}, {"AtmWtAg", 9.5}, {"SmLs01", 14.0}, {"SmLs02", 14.0},
      {"SmLs03", 14.0}, {"SmLs04", 10.0}, {"SmLs05", 10.0}, {"SmLs06", 10.0},
      {"SmLs07", 4.0},  {"SmLs08", 4.0},  {"SmLs09", 4.0}};
  std::printf("%-10s %12s\n", "anova", "F");
  for (const auto& [name, least] : problems) {
    const std::string path = "nist/anova/" + std::string(name) + ".dat";
    std::vector<std::string> labels;
    std::vector<double> values;
    for (const auto& row : nist_rows(path, 61, 20000)) {
      labels.push_back(std::to_string(row.at(0)));
      values.push_back(row.at(1));
    }
    const auto fit =
        one_way(grouped(labels, Eigen::Map<Vector>(values.data(), Eigen::Index(values.size()))));
    ASSERT_TRUE(fit) << name;
    const auto want = nist_line(path, "Between ");
    ASSERT_GE(want.size(), 3u) << name;
    std::printf("%-10s %12.1f\n", name, digits(fit->f, want.back()));
    EXPECT_GE(digits(fit->f, want.back()), least) << name;
  }
}

TEST(Nist, UnivariateSummariesHaveTheCertifiedDigits) {
  // NumAcc3 and NumAcc4 are not exact in doubles: 0.1 on 10⁶ and on 10⁷.
  const std::vector<std::pair<const char*, double>> problems = {
      {"PiDigits", 13.0}, {"Lottery", 14.0}, {"Lew", 14.0},    {"Mavro", 12.0}, {"Michelso", 13.0},
      {"NumAcc1", 14.0},  {"NumAcc2", 13.0}, {"NumAcc3", 9.0}, {"NumAcc4", 8.0}};
  std::printf("%-10s %12s %12s %12s\n", "univariate", "mean", "deviation", "lag 1");
  for (const auto& [name, least] : problems) {
    const std::string path = "nist/univariate/" + std::string(name) + ".dat";
    std::vector<double> values;
    for (const auto& row : nist_rows(path, 61, 20000)) values.push_back(row.at(0));
    const auto got = summary(Eigen::Map<Vector>(values.data(), Eigen::Index(values.size())));
    const double mean = digits(got.mean, nist_line(path, "ybar:")[0]);
    const double deviation = digits(got.deviation, nist_line(path, " s:")[0]);
    const double lag = digits(got.autocorrelation, nist_line(path, "r(1):")[0]);
    std::printf("%-10s %12.1f %12.1f %12.1f\n", name, mean, deviation, lag);
    EXPECT_GE(mean, 14.0) << name;
    EXPECT_GE(deviation, least) << name;
    EXPECT_GE(lag, least) << name;
  }
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
