/// Regressions on a million rows against R in the same run, digits on certified problems, a whole
/// cohort, and mixed models of crossed groupings.
#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <random>

#include "bench/statistics/certified.hpp"
#include "bench/statistics/cohort.hpp"
#include "bench/statistics/crossed.hpp"
#include "bench/statistics/r_peer.hpp"
#include "bench/support/report.hpp"
#include "core/file.hpp"
#include "statistics/anova/anova.hpp"
#include "statistics/regression/bisquare.hpp"
#include "statistics/regression/ols.hpp"

namespace tractus {
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

using bench::Answers;

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
          bench::seconds(15, bench::process_s, [&] { ols = statistics::ols(data.design, data.y); }),
          10.0);
  core::Result<statistics::Bisquare> robust = core::Error{core::Errc::bad_input, ""};
  statistics::BisquareOptions mass;
  mass.convention = statistics::BisquareConvention::mass;
  against(
      "bisquare, as MASS", "rlm_s",
      bench::seconds(5, bench::process_s,
                     [&] { robust = statistics::bisquare(data.design, data.with_outliers, mass); }),
      8.0);
  core::Result<statistics::OneWay> anova = core::Error{core::Errc::bad_input, ""};
  const std::vector<std::string> names = {"0", "1", "2", "3", "4", "5", "6", "7"};
  against("one-way analysis of variance", "aov_s",
          bench::seconds(15, bench::process_s,
                         [&] {
                           anova = statistics::one_way(
                               statistics::grouped(data.group, names, data.grouped));
                         }),
          20.0);
  report.row(
      "bisquare, as MATLAB",
      1e3 * bench::seconds(1, bench::process_s,
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

}  // namespace tractus

/// `--small`: a tenth of the rows; `--only rows|digits|cohort|mixed|answers`: one part.
int main(int argc, char** argv) {
  using namespace tractus;
  bool small = false;
  std::string only;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    small = small || word == "--small";
    if (word == "--only" && i + 1 < argc) only = argv[i + 1];
  }
  const auto wanted = [&](const char* part) { return only.empty() || only == part; };
  bench::Report report("statistics");
  auto folder = core::ScratchFolder::make(std::filesystem::temp_directory_path() / "bench");
  if (!folder) return 2;
  Eigen::Index n = wanted("rows") ? (small ? 100'000 : 1'000'000) : 0;
  Data data;
  if (n > 0) {
    data = made(n);
    store(data, folder->path());
  }
  Answers r;
  if (n > 0 || wanted("digits")) {
    r = bench::r_answers("peer.R", folder->path(), n);
    if (r.empty()) fmt::print("R is not here: ours alone\n");
  }
  if (n > 0) million_rows(report, data, r);
  if (wanted("digits")) bench::certified(report, r);
  if (wanted("cohort")) cohort(report, small);
  if (wanted("mixed")) bench::crossed(report, folder->path(), small);
  if (wanted("answers")) bench::crossed_answers(report, folder->path(), small);
  return report.finish(argc, argv);
}
