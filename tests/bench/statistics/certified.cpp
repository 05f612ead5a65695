#include "bench/statistics/certified.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bench/statistics/exact.hpp"
#include "statistics/anova/anova.hpp"
#include "statistics/regression/ols.hpp"
#include "statistics/summary/summary.hpp"

namespace tractus {
namespace bench {
namespace {

using statistics::Matrix;
using statistics::Vector;

constexpr std::size_t kFirstLine = 61;  // of the numbers, in every file

/// Least digits of each program over a problem's numbers; R's −1 when it did not answer.
struct Digits {
  double ours = 15.0, r = 15.0, exact = 15.0;

  void add(double want, double our, double their, double best) {
    ours = std::min(ours, digits(our, want));
    exact = std::min(exact, digits(best, want));
    r = std::isnan(their) ? -1.0 : std::min(r, digits(their, want));
  }
};

double at(const Answers& r, const std::string& name, std::size_t j) {
  const auto found = r.find(name);
  return found == r.end() || found->second.size() <= j ? std::nan("") : found->second[j];
}

struct Linear {
  const char* name;
  int powers;  // 0: the columns as they are
  bool intercept = true;
};

Digits of_linear(const Linear& problem, const Answers& r) {
  const std::string path = fmt::format("linear/{}.dat", problem.name);
  std::vector<std::vector<double>> x;
  std::vector<double> y;
  for (const auto& row : nist_rows(path, kFirstLine)) {
    y.push_back(row[0]);
    std::vector<double> own;
    if (problem.intercept) own.push_back(1.0);
    for (int k = 1; k <= problem.powers; ++k) own.push_back(std::pow(row[1], k));
    if (problem.powers == 0) own.insert(own.end(), row.begin() + 1, row.end());
    x.push_back(std::move(own));
  }
  const std::size_t p = x[0].size();
  statistics::Design design{Matrix(std::ssize(x), static_cast<Eigen::Index>(p)),
                            std::vector<std::string>(p, "x"), problem.intercept};
  for (std::size_t i = 0; i < x.size(); ++i)
    design.columns.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(x[i].data(), static_cast<Eigen::Index>(p));
  const auto fit = statistics::ols(design, Eigen::Map<const Vector>(y.data(), std::ssize(y)));
  const auto exact = exact_coefficients(x, y);
  Digits out;
  for (std::size_t j = 0; j < p; ++j) {
    const auto label = fmt::format(" B{} ", problem.intercept ? j : j + 1);
    out.add(nist_line(path, label).at(0),
            fit ? fit->coefficients[static_cast<Eigen::Index>(j)] : std::nan(""),
            at(r, std::string("nist_") + problem.name, j), exact[j]);
  }
  return out;
}

Digits of_anova(const std::string& name, const Answers& r) {
  const std::string path = fmt::format("anova/{}.dat", name);
  std::vector<std::string> labels;
  std::vector<double> values;
  for (const auto& row : nist_rows(path, kFirstLine)) {
    if (row.size() < 2) continue;
    labels.push_back(fmt::format("{}", row[0]));
    values.push_back(row[1]);
  }
  const auto fit = statistics::one_way(
      statistics::grouped(labels, Eigen::Map<Vector>(values.data(), std::ssize(values))));
  Digits out;
  out.add(nist_line(path, "Between ").back(), fit ? fit->f : std::nan(""), at(r, "nist_" + name, 0),
          exact_f(labels, values));
  return out;
}

Digits of_univariate(const std::string& name, const Answers& r) {
  const std::string path = fmt::format("univariate/{}.dat", name);
  std::vector<double> values;
  for (const auto& row : nist_rows(path, kFirstLine)) values.push_back(row[0]);
  const auto got = statistics::summary(Eigen::Map<const Vector>(values.data(), std::ssize(values)));
  const auto exact = exact_summary(values);
  Digits out;
  const std::string key = "nist_" + name;
  out.add(nist_line(path, "ybar:").at(0), got.mean, at(r, key, 0), exact.mean);
  out.add(nist_line(path, " s:").at(0), got.deviation, at(r, key, 1), exact.deviation);
  out.add(nist_line(path, "r(1):").at(0), got.autocorrelation, at(r, key, 2),
          exact.autocorrelation);
  return out;
}

}  // namespace

void certified(Report& report, const Answers& r) {
  fmt::print("\ncorrect digits, least of a problem\n  {:<14}{:>7}{:>7}{:>22}\n", "", "ours", "R",
             "exact on the doubles");
  double worst = 15.0;
  const auto line = [&](const std::string& name, const Digits& of) {
    fmt::print("  {:<14}{:7.1f}{:>7}{:22.1f}\n", name, of.ours,
               of.r < 0 ? "-" : fmt::format("{:.1f}", of.r), of.exact);
    worst = std::min(worst, of.ours - (of.r < 0 ? of.exact : std::min(of.r, of.exact)));
  };
  for (const Linear& problem : {Linear{"Norris", 1},
                                {"Pontius", 2},
                                {"NoInt1", 1, false},
                                {"NoInt2", 1, false},
                                {"Filip", 10},
                                {"Longley", 0},
                                {"Wampler1", 5},
                                {"Wampler2", 5},
                                {"Wampler3", 5},
                                {"Wampler4", 5},
                                {"Wampler5", 5}})
    line(problem.name, of_linear(problem, r));
  for (const char* name : {"SiRstv", "AtmWtAg", "SmLs01", "SmLs02", "SmLs03", "SmLs04", "SmLs05",
                           "SmLs06", "SmLs07", "SmLs08", "SmLs09"})
    line(name, of_anova(name, r));
  for (const char* name : {"PiDigits", "Lottery", "Lew", "Mavro", "Michelso", "NumAcc1", "NumAcc2",
                           "NumAcc3", "NumAcc4"})
    line(name, of_univariate(name, r));
  // A tenth of a digit is the noise of the last bit.
  report.at_least("digits, ours less R's or what doubles allow, worst", worst, -0.1, "");
}

}  // namespace bench
}  // namespace tractus
