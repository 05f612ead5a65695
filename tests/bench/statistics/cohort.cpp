#include "bench/statistics/cohort.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "assessment/analyse.hpp"
#include "assessment/trainee.hpp"
#include "bench/support/report.hpp"

namespace tractus {
namespace bench {

std::string simulated_cohort(int trainees, int trials) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const char* scenarios[] = {"hard", "soft", "lateral", "inoutin"};
  std::string out =
      "participant,experience_years,order,repetition,scenario,breach,said,correct,time_s,force_N\n";
  for (int i = 0; i < trainees; ++i) {
    const double own = normal(random), years = std::floor(10.0 * uniform(random)) / 2.0;
    for (int t = 0; t < trials; ++t) {
      const int scenario = t % 4;
      const bool breach = scenario > 1;
      const double chance = 1.0 / (1.0 + std::exp(-(0.5 + 0.02 * t + 0.5 * own)));
      const bool right = uniform(random) < chance;
      out += fmt::format("p{:05},{},{},{},{},{:d},{:d},{:d},{:.3f},{:.3f}\n", i, years, t + 1,
                         t / 4 + 1, scenarios[scenario], breach, right == breach, right,
                         12.0 * std::pow(t + 1.0, -0.2) + own + 0.5 * normal(random),
                         40.0 + 2.0 * own + years + 3.0 * normal(random));
    }
  }
  return out;
}

namespace {

struct Standard {
  const char* method;
  const char* formula;
};

/// What a study's report asks of a cohort.
constexpr Standard kStandard[] = {
    {"describe", "force_N ~ scenario"},
    {"ols", "force_N ~ experience_years + order"},
    {"robust", "force_N ~ experience_years + order"},
    {"anova", "time_s ~ repetition"},
    {"rm-anova", "time_s ~ order + (1|participant)"},
    {"rank", "time_s ~ scenario"},
    {"lmm", "time_s ~ order + experience_years + (1|participant)"},
    {"logistic", "correct ~ order + experience_years"},
    {"logistic", "correct ~ scenario + experience_years + (1|participant)"},
    {"recognition", "said ~ breach + (1|participant)"},
    {"proportions", "correct ~ scenario"},
    {"confusion", "said ~ breach"},
    {"icc", "time_s ~ order + (1|participant)"}};

core::Json plan_of(const Standard& one) {
  return {{"format", "tractus-plan/1"},
          {"title", "standard analyses"},
          {"question", "all"},
          {"subject", "participant"},
          {"analyses",
           {{{"id", "one"}, {"family", "all"}, {"method", one.method}, {"formula", one.formula}}}}};
}

/// Why it could not be done; empty when it was.
std::string fault_of(const Standard& one, const assessment::Table& table) {
  const auto plan = assessment::Plan::from_json(plan_of(one), "plan");
  if (!plan) return plan.error().what;
  const auto done = assessment::analyse(*plan, table);
  if (!done) return done.error().what;
  const auto& entry = done->result["analyses"][0];
  return entry.contains("error") ? entry["error"].get<std::string>() : "";
}

}  // namespace

bool analyse_cohort(const std::string& csv, std::string& failed) {
  const auto bytes = core::bytes_of(csv);
  const auto table = assessment::Table::parse({bytes.begin(), bytes.end()}, "cohort", {},
                                              assessment::Missing::keep);
  if (!table) return failed = table.error().what, false;
  fmt::print("\nsimulated cohort, {} rows\n", table->rows());
  for (const auto& one : kStandard) {
    const double start = wall_s();
    const auto why = fault_of(one, *table);
    if (!why.empty()) return failed = fmt::format("{}: {}", one.formula, why), false;
    fmt::print("  {:<12}{:<58}{:8.2f} s\n", one.method, one.formula, wall_s() - start);
    std::fflush(stdout);
  }
  const double planned = wall_s();
  assessment::TraineeColumns columns;
  columns.scores = {"time_s"};
  const auto cohort = assessment::cohort_of(*table, columns);
  if (!cohort) return failed = cohort.error().what, false;
  const auto rule = assessment::certification({0.10, 0.25});
  std::size_t certified = 0;
  for (std::size_t i = 0; i < cohort->trainees.size(); ++i) {
    const auto report = assessment::trainee_report(*cohort, i, rule, {{0.10, 0.25}, {}, 1.25});
    certified += report.report["certified"] == true ? 1u : 0u;
  }
  fmt::print("  {:<70}{:8.2f} s\n", fmt::format("every trainee's page, {} certified", certified),
             wall_s() - planned);
  return true;
}

}  // namespace bench
}  // namespace tractus
