#include "assessment/simulated_power.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "statistics/power/simulated_power.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::SimulatedPower;
using statistics::StudyDesign;

StudyDesign design_of(const Analysis& of) {
  using Compares = StudyDesign::Compares;
  const std::string& compares = of.text("compares");
  StudyDesign out;
  out.compares = compares == "groups"   ? Compares::groups
                 : compares == "trials" ? Compares::trials
                                        : Compares::conditions;
  out.trials = int(of.number("trials"));
  out.scenarios = int(of.number("scenarios"));
  out.effect = of.number("effect");
  out.surgeon_sd = of.number("surgeon-sd");
  out.slope_sd = of.number("slope-sd");
  out.scenario_sd = of.number("scenario-sd");
  out.residual_sd = of.number("residual-sd");
  out.alpha = of.number("alpha");
  out.df = of.text("df") == "kenward-roger" ? statistics::SmallSample::kenward_roger
                                            : statistics::SmallSample::satterthwaite;
  return out;
}

/// The analysis that the power is of, as the formula of 'lmm'.
std::string analysis_of(const StudyDesign& design) {
  using Compares = StudyDesign::Compares;
  const char* x = design.compares == Compares::trials   ? "trial"
                  : design.compares == Compares::groups ? "group"
                                                        : "condition";
  if (design.trials == 1) return fmt::format("ols: y ~ {}", x);
  return fmt::format("lmm: y ~ {} + ({} | surgeon){}", x, design.slope_sd > 0.0 ? "1 + trial" : "1",
                     design.scenarios > 1 ? " + (1 | scenario)" : "");
}

Json answer_of(const StudyDesign& design, const SimulatedPower& power) {
  return {{"n", power.surgeons},
          {"counts",
           design.compares == StudyDesign::Compares::groups ? "surgeons per group" : "surgeons"},
          {"power", power.power},
          {"monte_carlo95_low", power.interval.low},
          {"monte_carlo95_high", power.interval.high},
          {"runs", power.runs},
          {"significant", power.significant},
          {"not_analysed", power.failed}};
}

core::Result<void> check_whole(const Analysis& of) {
  for (const char* option : {"n", "trials", "scenarios", "runs", "seed"})
    if (of.given(option) && of.number(option) != double(std::int64_t(of.number(option))))
      return core::bad_input(
          fmt::format("power: {} is {}; a whole number is expected", option, of.text(option)));
  return {};
}

}  // namespace

std::vector<Option> simulated_power_options() {
  return {
      {"compares",
       "mixed: whose effect is tested; trials: a trend over a surgeon's trials, groups: two groups "
       "of surgeons, conditions: two conditions that each surgeon meets in turn",
       "trials",
       {"trials", "groups", "conditions"}},
      {"trials", "mixed: trials of each surgeon", "12", {}, 1, 1000},
      {"scenarios", "mixed: scenarios, taken in turn", "1", {}, 1, 1000},
      {"surgeon-sd", "mixed: standard deviation between surgeons", "0", {}, 0, 1e6},
      {"slope-sd", "mixed: of surgeons' trends, per trial", "0", {}, 0, 1e6},
      {"scenario-sd", "mixed: between scenarios", "0", {}, 0, 1e6},
      {"residual-sd", "mixed: of one trial", "1", {}, 1e-6, 1e6},
      {"df",
       "mixed: degrees of freedom of the test",
       "satterthwaite",
       {"satterthwaite", "kenward-roger"}},
      {"runs", "mixed: simulated studies", "1000", {}, 100, 100'000},
      {"seed", "mixed: of the random numbers", "1", {}, 0, 1e9}};
}

core::Result<Findings> simulated_power(const Analysis& of) {
  TRY(check_whole(of));
  StudyDesign design = design_of(of);
  const int runs = int(of.number("runs"));
  const auto seed = std::uint64_t(of.number("seed"));
  Json out = {{"method", "power of a mixed model, by simulation"}};
  out["design"] = {{"effect", design.effect},
                   {"compares", of.text("compares")},
                   {"trials", design.trials},
                   {"scenarios", design.scenarios},
                   {"sd_between_surgeons", design.surgeon_sd},
                   {"sd_of_trends", design.slope_sd},
                   {"sd_between_scenarios", design.scenario_sd},
                   {"sd_of_a_trial", design.residual_sd},
                   {"alpha", design.alpha},
                   {"analysis", analysis_of(design)},
                   {"degrees_of_freedom", of.text("df")},
                   {"seed", seed}};
  if (of.given("n")) {
    if (of.number("n") > 2000.0)
      return core::bad_input("power: at most 2000 surgeons are simulated");
    design.surgeons = int(of.number("n"));
    const auto power = TRY(statistics::simulated_power(design, runs, seed, of.progress));
    out["answer"] = answer_of(design, power);
  } else {
    const double target = of.number("power");
    const auto power = TRY(statistics::needed_surgeons(design, target, runs, seed, of.progress));
    out["answer"] = answer_of(design, power);
    out["answer"]["power_wanted"] = target;
  }
  out["notes"] = {
      "simulated studies, drawn from the spreads stated above: power for other spreads is another"};
  if (design.trials > 1 && design.surgeon_sd == 0.0)
    out["notes"].push_back(
        "no spread between surgeons is assumed (surgeon-sd 0): surgeons do differ, so this is the "
        "best case");
  return Findings{std::move(out), {}};
}

}  // namespace assessment
}  // namespace tractus
