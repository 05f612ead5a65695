#include "statistics/power/simulated_power.hpp"

#include <cmath>
#include <optional>
#include <random>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/regression/ols.hpp"

namespace tractus {
namespace statistics {
namespace {

using Compares = StudyDesign::Compares;
constexpr int kMostSurgeons = 2000;

/// Standard normal numbers; std::normal_distribution differs between libraries.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : random_(seed) {}
  double operator()() {
    return normal_quantile((static_cast<double>(random_() >> 12) + 0.5) * 0x1p-52);
  }

 private:
  std::mt19937_64 random_;
};

/// The rows of a study, the same in each run.
struct Rows {
  Design design;
  Vector trial;
  std::vector<int> surgeon_of, scenario_of;
  std::vector<std::string> surgeons, scenarios;
  int people = 0;
};

Rows rows_of(const StudyDesign& study) {
  Rows out;
  out.people = study.surgeons * (study.compares == Compares::groups ? 2 : 1);
  const Eigen::Index count = Eigen::Index(out.people) * study.trials;
  Vector x(count);
  out.trial.resize(count);
  Eigen::Index row = 0;
  for (int i = 0; i < out.people; ++i)
    for (int t = 0; t < study.trials; ++t, ++row) {
      // Both conditions meet a scenario before the next one comes.
      const int step = study.compares == Compares::conditions ? t / 2 : t;
      const int scenario = (step + i) % study.scenarios;
      out.trial[row] = t + 1;
      out.surgeon_of.push_back(i);
      out.scenario_of.push_back(scenario);
      out.surgeons.push_back(std::to_string(i));
      out.scenarios.push_back(std::to_string(scenario));
      x[row] = study.compares == Compares::trials   ? t + 1
               : study.compares == Compares::groups ? i % 2
                                                    : (t + i) % 2;
    }
  out.design = with_intercept(x, {"x"});
  return out;
}

Vector drawn(const StudyDesign& study, const Rows& rows, Normal& normal) {
  std::vector<double> level(std::size_t(rows.people)), slope(level.size()),
      shift(std::size_t(study.scenarios));
  for (auto& value : level) value = study.surgeon_sd * normal();
  for (auto& value : slope) value = study.slope_sd * normal();
  for (auto& value : shift) value = study.scenario_sd * normal();
  Vector out(rows.trial.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto who = std::size_t(rows.surgeon_of[std::size_t(i)]),
               what = std::size_t(rows.scenario_of[std::size_t(i)]);
    out[i] = study.effect * rows.design.columns(i, 1) + level[who] + slope[who] * rows.trial[i] +
             shift[what] + study.residual_sd * normal();
  }
  return out;
}

std::vector<RandomTerm> terms_of(const StudyDesign& study, const Rows& rows) {
  const auto n = rows.trial.size();
  RandomTerm surgeon{"surgeon", rows.surgeons, Matrix::Ones(n, 1), {"(Intercept)"}};
  if (study.slope_sd > 0.0) {
    surgeon.columns.conservativeResize(n, 2);
    surgeon.columns.col(1) = rows.trial;
    surgeon.names.push_back("trial");
  }
  std::vector<RandomTerm> out = {std::move(surgeon)};
  if (study.scenarios > 1)
    out.push_back({"scenario", rows.scenarios, Matrix::Ones(n, 1), {"(Intercept)"}});
  return out;
}

/// p of x in one study's data.
core::Result<double> p_of(const StudyDesign& study, const Rows& rows,
                          const std::vector<RandomTerm>& terms, const Vector& y) {
  const bool by_kr = study.df == SmallSample::kenward_roger;
  if (study.trials == 1) {
    const auto fit = TRY(ols(rows.design, y));
    return fit.p[1];
  }
  if (terms.size() == 1 && terms[0].names.size() == 1) {
    const auto fit = TRY(lmm(rows.design, y, rows.surgeons));
    return by_kr ? kenward_roger(fit).p[1] : fit.p[1];
  }
  const auto fit = TRY(mixed_model(rows.design, y, terms));
  if (!by_kr) return fit.p[1];
  const auto tests = TRY(kenward_roger(fit, rows.design, terms));
  return tests.p[1];
}

core::Result<void> check(const StudyDesign& study) {
  core::require(study.residual_sd > 0.0, "a study's residual has a spread");
  const auto refused = [](const char* what) {
    return core::bad_input(std::string("power: ") + what);
  };
  if (study.surgeons < 2) return refused("at least 2 surgeons are needed");
  if (study.trials < 1 || study.scenarios < 1)
    return refused("at least 1 trial of 1 scenario is needed");
  if (study.trials == 1 && study.compares != Compares::groups)
    return refused("a comparison within surgeons needs 2 trials of each");
  if (study.trials == 1 && study.scenarios > 1)
    return refused("with 1 trial of each surgeon there is 1 scenario");
  if (study.slope_sd > 0.0 && study.trials < 3)
    return refused("slopes that vary between surgeons need 3 trials of each");
  if (study.scenarios > study.trials)
    return refused("each surgeon needs a trial of each scenario at least");
  return {};
}

SimulatedPower counted(const StudyDesign& study, int runs, int significant, int failed) {
  SimulatedPower out{study.surgeons, runs, significant, failed, 0.0, {}};
  const Proportion share{double(significant), double(runs)};
  out.power = share.share();
  out.interval = wilson(share);
  return out;
}

/// Runs until `runs`, or until it is clear on which side of `target` the power lies.
core::Result<SimulatedPower> run_all(const StudyDesign& study, int runs, std::uint64_t seed,
                                     std::optional<double> target, const core::Progress& progress) {
  TRY(check(study));
  const Rows rows = rows_of(study);
  const auto terms = terms_of(study, rows);
  int significant = 0, failed = 0;
  for (int run = 0; run < runs; ++run) {
    if (progress && !progress(double(run) / runs))
      return core::Error{core::Errc::cancelled, "stopped"};
    Normal normal(seed * 1'000'003u + std::uint64_t(run));
    const auto p = p_of(study, rows, terms, drawn(study, rows, normal));
    failed += p ? 0 : 1;
    significant += p && *p < study.alpha ? 1 : 0;
    if (!target || (run + 1) % 50 != 0) continue;
    const auto sure = wilson({double(significant), double(run + 1)}, 0.999);
    if (sure.low > *target || sure.high < *target)
      return counted(study, run + 1, significant, failed);
  }
  if (progress) progress(1.0);
  return counted(study, runs, significant, failed);
}

}  // namespace

core::Result<SimulatedPower> simulated_power(const StudyDesign& design, int runs,
                                             std::uint64_t seed, const core::Progress& progress) {
  return run_all(design, runs, seed, std::nullopt, progress);
}

core::Result<SimulatedPower> needed_surgeons(StudyDesign design, double target, int runs,
                                             std::uint64_t seed, const core::Progress& progress) {
  int step = 0;
  const auto at = [&](int surgeons, std::optional<double> stop_at) {
    design.surgeons = surgeons;
    ++step;
    return run_all(design, runs, seed, stop_at, [&](double share) {
      return !progress || progress(1.0 - 1.0 / (1.0 + 0.2 * (step - 1 + share)));
    });
  };
  int low = 1, high = 2;  // too few, and enough
  while (TRY(at(high, target)).power < target) {
    if (high >= kMostSurgeons)
      return core::Error{
          core::Errc::out_of_range,
          "2000 surgeons would not be enough: the effect is too small, or more trials "
          "or scenarios are needed"};
    low = high;
    high = std::min(kMostSurgeons, 2 * high);
  }
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (TRY(at(middle, target)).power < target ? low : high) = middle;
  }
  auto out = TRY(at(high, std::nullopt));
  while (out.power < target && high < kMostSurgeons) out = TRY(at(++high, std::nullopt));
  if (progress) progress(1.0);
  return out;
}

}  // namespace statistics
}  // namespace tractus
