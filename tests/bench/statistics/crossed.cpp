#include "bench/statistics/crossed.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <random>

#include "bench/statistics/r_peer.hpp"
#include "statistics/mixed/logistic_mixed_model.hpp"
#include "statistics/mixed/mixed_model.hpp"

namespace tractus {
namespace bench {
namespace {

using statistics::Matrix;
using statistics::Vector;

struct Trials {
  Vector y, right, trial, surgeon, scenario;  // a measure, and a yes-or-no answer
  std::vector<statistics::RandomTerm> terms;
};

Trials simulated(Eigen::Index rows, std::size_t surgeons, std::size_t scenarios) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> level(surgeons), shift(scenarios);
  for (auto& value : level) value = normal(random);
  for (auto& value : shift) value = 0.6 * normal(random);
  Trials out{Vector(rows), Vector(rows), Vector(rows), Vector(rows), Vector(rows), {}};
  std::vector<std::string> who, what;
  std::uniform_real_distribution<double> uniform;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t surgeon = random() % surgeons, scenario = random() % scenarios;
    out.trial[i] = double(1 + random() % 12);
    out.surgeon[i] = double(surgeon);
    out.scenario[i] = double(scenario);
    out.y[i] = 3.0 - 0.2 * out.trial[i] + level[surgeon] + shift[scenario] + 0.8 * normal(random);
    const double logit = -1.0 + 0.2 * out.trial[i] + level[surgeon] + shift[scenario];
    out.right[i] = uniform(random) < 1.0 / (1.0 + std::exp(-logit)) ? 1.0 : 0.0;
    who.push_back("s" + std::to_string(surgeon));
    what.push_back("c" + std::to_string(scenario));
  }
  const Matrix ones = Matrix::Ones(rows, 1);
  out.terms = {{"surgeon", who, ones, {"(Intercept)"}}, {"scenario", what, ones, {"(Intercept)"}}};
  return out;
}

void store(const std::filesystem::path& path, const Vector& values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             values.size() * Eigen::Index(sizeof(double)));
}

void store(const std::filesystem::path& folder, const Trials& of, const Vector& response) {
  store(folder / "y.bin", response);
  store(folder / "trial.bin", of.trial);
  store(folder / "surgeon.bin", of.surgeon);
  store(folder / "scenario.bin", of.scenario);
}

double largest_difference(const std::vector<double>& ours, const std::vector<double>& theirs) {
  double most = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    most = std::max(most, std::abs(ours[i] - theirs[i]) / std::abs(theirs[i]));
  return most;
}

double most_memory_MB() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024.0;
}

}  // namespace

void crossed(Report& report, const std::filesystem::path& folder, bool small) {
  const Eigen::Index rows = small ? 100'000 : 1'000'000;
  const Trials of = simulated(rows, small ? 1000 : 10'000, small ? 100 : 1000);
  const auto design = statistics::with_intercept(of.trial, {"trial"});
  core::Result<statistics::MixedModel> fit = core::Error{core::Errc::bad_input, ""};
  const double s =
      seconds(1, process_s, [&] { fit = statistics::mixed_model(design, of.y, of.terms); });
  report.must("the mixed model's minimum was reached", fit && fit->converged);
  if (!fit) return;
  report.at_most("mixed model, surgeons crossed with scenarios", s, small ? 10.0 : 120.0, "s");
  report.row("largest memory of the process", most_memory_MB(), "MB");
  store(folder, of, of.y);
  const Answers r = r_answers("crossed_peer.R", folder, rows);
  if (!r.contains("lmer")) return;
  report.row("the same by lme4", r.at("lmer_s")[0], "s");
  // lme4's search ends where its tolerance says, ours where rounding does: the criterion tells.
  const auto& theirs = r.at("lmer");
  report.at_most("criterion above lme4's, relative", (fit->criterion - theirs[0]) / theirs[0],
                 1e-12, "");
  const std::vector<double> ours = {fit->criterion, fit->sigma_squared, fit->coefficients[0],
                                    fit->coefficients[1], fit->standard_errors[1]};
  report.at_most("estimates, difference to lme4", largest_difference(ours, theirs), 1e-6, "");
}

void crossed_answers(Report& report, const std::filesystem::path& folder, bool small) {
  for (const bool tenth : {true, false}) {
    if (small && !tenth) break;
    const Eigen::Index rows = tenth ? 100'000 : 1'000'000;
    const Trials of = simulated(rows, tenth ? 1000 : 10'000, tenth ? 100 : 1000);
    const auto design = statistics::with_intercept(of.trial, {"trial"});
    core::Result<statistics::LogisticMixedModel> fit = core::Error{core::Errc::bad_input, ""};
    const double s = seconds(1, process_s, [&] {
      fit = statistics::logistic_mixed_model(design, {of.right, Vector::Ones(rows)}, of.terms);
    });
    report.must("the logistic mixed model's minimum was reached", fit && fit->converged);
    if (!fit) return;
    report.row(fmt::format("logistic mixed model of {} answers", rows), s, "s");
    report.row("largest memory of the process", most_memory_MB(), "MB");
    store(folder, of, of.right);
    const Answers r = r_answers("crossed_answers_peer.R", folder, rows);
    if (!r.contains("glmer")) continue;
    const auto& theirs = r.at("glmer");
    const double deviance = -2.0 * fit->log_likelihood;
    if (!tenth) {  // of the whole lme4 does the rougher approximation alone: its estimates differ
      report.row("lme4's approximation without integration (nAGQ = 0)", r.at("glmer_s")[0], "s");
      report.row("that over ours", r.at("glmer_s")[0] / s, "x");
      continue;
    }
    report.row("the same by lme4", r.at("glmer_s")[0], "s");
    report.at_least("lme4 over ours", r.at("glmer_s")[0] / s, 3.0, "x");
    report.at_most("deviance above lme4's, relative", (deviance - theirs[0]) / theirs[0], 1e-9, "");
    // glmer stops early: its deviance tells how early.
    report.at_most("estimates, difference to lme4",
                   largest_difference({deviance, std::sqrt(fit->random[0].covariance(0, 0)),
                                       std::sqrt(fit->random[1].covariance(0, 0)),
                                       fit->coefficients[0], fit->coefficients[1]},
                                      theirs),
                   1e-3, "");
  }
}

}  // namespace bench
}  // namespace tractus
