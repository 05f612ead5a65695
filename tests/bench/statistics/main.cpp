/// Regressions on a million rows against R in the same run, digits on certified problems, and a
/// whole cohort.
#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <random>

#include "bench/statistics/cohort.hpp"
#include "bench/statistics/r_peer.hpp"
#include "bench/support/report.hpp"
#include "core/file.hpp"
#include "statistics/anova.hpp"
#include "statistics/bisquare.hpp"
#include "statistics/ols.hpp"

namespace {

using statistics::Matrix;
using statistics::Vector;

struct Data {
  statistics::Design design;
  Vector y, with_outliers, grouped;
  std::vector<std::size_t> group;
};

Data made(Eigen::Index n) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Data out;
  Matrix x(n, 5);
  out.y.resize(n);
  out.with_outliers.resize(n);
  out.grouped.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < 5; ++j) x(i, j) = 3.0 * double(j) + normal(random);
    out.y[i] = 1.0 + x(i, 0) - 0.5 * x(i, 1) + 0.25 * x(i, 2) + 0.1 * x(i, 4) + normal(random);
    out.with_outliers[i] = out.y[i] + (i % 20 == 0 ? 15.0 * normal(random) : 0.0);
    out.group.push_back(static_cast<std::size_t>(random() % 8));
    out.grouped[i] = 10.0 + 0.01 * double(out.group.back()) + normal(random);
  }
  out.design = statistics::with_intercept(x, {"X1", "X2", "X3", "X4", "X5"});
  return out;
}

void store(const std::filesystem::path& path, const double* values, Eigen::Index count) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values), count * Eigen::Index(sizeof(double)));
}

void store(const Data& data, const std::filesystem::path& folder) {
  const auto n = data.y.size();
  store(folder / "x.bin", data.design.columns.data() + n, 5 * n);  // without the ones
  store(folder / "y.bin", data.y.data(), n);
  store(folder / "yr.bin", data.with_outliers.data(), n);
  store(folder / "yg.bin", data.grouped.data(), n);
  const std::vector<double> codes(data.group.begin(), data.group.end());
  store(folder / "g.bin", codes.data(), n);
}

using Answers = std::map<std::string, std::vector<double>>;

/// Largest relative difference; infinite when R did not answer.
double difference(const Answers& r, const std::string& name, const Vector& ours) {
  const auto at = r.find(name);
  if (at == r.end() || std::ssize(at->second) != ours.size()) return HUGE_VAL;
  double most = 0.0;
  for (Eigen::Index j = 0; j < ours.size(); ++j) {
    const double theirs = at->second[static_cast<std::size_t>(j)];
    most = std::max(most, std::abs(ours[j] - theirs) / std::abs(theirs));
  }
  return most;
}

void million_rows(bench::Report& report, const Data& data, const Answers& r) {
  const auto against = [&](const char* what, const char* key, double ours_s, double least) {
    report.row(what, 1e3 * ours_s, "ms");
    if (!r.contains(key)) return;
    report.row(std::string(what) + ", R", 1e3 * r.at(key)[0], "ms");
    report.at_least(std::string(what) + ", R over ours", r.at(key)[0] / ours_s, least, "x");
  };
  core::Result<statistics::Ols> ols = core::Error{core::Errc::bad_input, ""};
  against("least squares", "lm_s",
          bench::seconds(5, bench::wall_s, [&] { ols = statistics::ols(data.design, data.y); }),
          10.0);
  core::Result<statistics::Bisquare> robust = core::Error{core::Errc::bad_input, ""};
  statistics::BisquareOptions mass;
  mass.convention = statistics::BisquareConvention::mass;
  against(
      "bisquare, as MASS", "rlm_s",
      bench::seconds(3, bench::wall_s,
                     [&] { robust = statistics::bisquare(data.design, data.with_outliers, mass); }),
      8.0);
  core::Result<statistics::OneWay> anova = core::Error{core::Errc::bad_input, ""};
  const std::vector<std::string> names = {"0", "1", "2", "3", "4", "5", "6", "7"};
  against("one-way analysis of variance", "aov_s",
          bench::seconds(5, bench::wall_s,
                         [&] {
                           anova = statistics::one_way(
                               statistics::grouped(data.group, names, data.grouped));
                         }),
          20.0);
  report.row(
      "bisquare, as MATLAB",
      1e3 * bench::seconds(1, bench::wall_s,
                           [&] { (void)statistics::bisquare(data.design, data.with_outliers); }),
      "ms");
  if (r.empty()) return;
  report.at_most("least squares, difference to R", difference(r, "lm", ols->coefficients), 1e-8,
                 "");
  report.at_most("its standard errors", difference(r, "lm_se", ols->standard_errors), 1e-8, "");
  report.at_most("bisquare, difference to R", difference(r, "rlm", robust->coefficients), 1e-8, "");
  report.at_most("its standard errors", difference(r, "rlm_se", robust->standard_errors), 1e-8, "");
  report.at_most("F and p, difference to R",
                 difference(r, "aov", Eigen::Vector2d(anova->f, anova->p)), 1e-8, "");
}

struct Problem {
  const char* name;
  int powers;  // 0: the columns as they are
};

double ours_of(const Problem& problem, const std::string& path) {
  const auto rows = bench::nist_rows(path, 61);
  const auto n = std::ssize(rows);
  const auto k = problem.powers > 0 ? Eigen::Index(problem.powers) : std::ssize(rows[0]) - 1;
  Matrix x(n, k);
  Vector y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    y[i] = row[0];
    for (Eigen::Index j = 0; j < k; ++j)
      x(i, j) = problem.powers > 0 ? std::pow(row[1], double(j + 1))
                                   : row[static_cast<std::size_t>(j + 1)];
  }
  const auto fit = statistics::ols(
      statistics::with_intercept(x, std::vector<std::string>(static_cast<std::size_t>(k), "x")), y);
  double least = fit ? 15.0 : 0.0;
  for (Eigen::Index j = 0; fit && j <= k; ++j)
    least = std::min(least, bench::digits(fit->coefficients[j],
                                          bench::nist_line(path, fmt::format(" B{} ", j)).at(0)));
  return least;
}

/// Digits of R's coefficients; −1 when it did not answer.
double theirs_of(const Answers& r, const std::string& name, const std::string& path) {
  const auto at = r.find("nist_" + name);
  if (at == r.end()) return -1.0;
  double least = 15.0;
  for (std::size_t j = 0; j < at->second.size(); ++j)
    least = std::min(
        least, bench::digits(at->second[j], bench::nist_line(path, fmt::format(" B{} ", j)).at(0)));
  return least;
}

double anova_digits(const std::string& path) {
  std::vector<std::string> labels;
  std::vector<double> values;
  for (const auto& row : bench::nist_rows(path, 61)) {
    if (row.size() < 2) continue;
    labels.push_back(fmt::format("{}", row[0]));
    values.push_back(row[1]);
  }
  const auto fit = statistics::one_way(
      statistics::grouped(labels, Eigen::Map<Vector>(values.data(), std::ssize(values))));
  return fit ? bench::digits(fit->f, bench::nist_line(path, "Between ").back()) : 0.0;
}

void certified(bench::Report& report, const Answers& r) {
  fmt::print("\ncorrect digits     ours      R\n");
  double worst = 15.0;
  const auto line = [&](const std::string& name, double ours, double theirs) {
    fmt::print("  {:<14}{:7.1f}{:>7}\n", name, ours,
               theirs < 0 ? "-" : fmt::format("{:.1f}", theirs));
    if (theirs >= 0) worst = std::min(worst, ours - theirs);
  };
  for (const Problem& problem : {Problem{"Norris", 1},
                                 {"Pontius", 2},
                                 {"Longley", 0},
                                 {"Filip", 10},
                                 {"Wampler1", 5},
                                 {"Wampler2", 5},
                                 {"Wampler3", 5},
                                 {"Wampler4", 5},
                                 {"Wampler5", 5}}) {
    const std::string path = fmt::format("linear/{}.dat", problem.name);
    line(problem.name, ours_of(problem, path), theirs_of(r, problem.name, path));
  }
  for (const char* name : {"SiRstv", "AtmWtAg", "SmLs01", "SmLs02", "SmLs03", "SmLs04", "SmLs05",
                           "SmLs06", "SmLs07", "SmLs08", "SmLs09"}) {
    const std::string path = fmt::format("anova/{}.dat", name);
    const auto at = r.find(std::string("nist_") + name);
    line(name, anova_digits(path),
         at == r.end()
             ? -1.0
             : bench::digits(at->second.at(0), bench::nist_line(path, "Between ").back()));
  }
  // Half a digit is the noise of the last bit.
  if (!r.empty()) report.at_least("digits, ours less R's, worst problem", worst, -0.5, "");
}

void cohort(bench::Report& report, bool small) {
  const std::string csv = bench::simulated_cohort(small ? 1000 : 10'000, 100);
  std::string failed;
  bool fine = false;
  const double s =
      bench::seconds(1, bench::wall_s, [&] { fine = bench::analyse_cohort(csv, failed); });
  if (!fine) fmt::print("  {}\n", failed);
  report.must("every standard analysis was done", fine);
  report.at_most("10 000 trainees × 100 trials, all analyses", s * (small ? 10.0 : 1.0), 10.0, "s");
}

}  // namespace

int main(int argc, char** argv) {
  bool small = false;
  for (int i = 1; i < argc; ++i) small = small || std::string(argv[i]) == "--small";
  bench::Report report("statistics");
  auto folder = core::ScratchFolder::make(std::filesystem::temp_directory_path() / "bench");
  if (!folder) return 2;
  const Eigen::Index n = small ? 100'000 : 1'000'000;
  const Data data = made(n);
  store(data, folder->path());
  const Answers r = bench::r_answers(folder->path(), n);
  if (r.empty()) fmt::print("R is not here: ours alone\n");
  million_rows(report, data, r);
  certified(report, r);
  cohort(report, small);
  return report.finish(argc, argv);
}
