/// `tractus trainee`: the page of one trainee, or the list of all.
#include "assessment/trainee.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Json;

struct TraineeOptions {
  std::string data, who, html;
  assessment::TraineeColumns columns;
  double adequate = 0.10, inadequate = 0.25, threshold = 0.0, relapse = 1.25;
  bool json = false, simulated = false;
};

void print_one(const Json& r) {
  std::printf(
      "%s: %ld of %ld right (%.0f %% to %.0f %%), %s\n%s\n",
      r["trainee"].get<std::string>().c_str(), r["right"].get<long>(), r["trials"].get<long>(),
      100.0 * r["wilson_low"].get<double>(), 100.0 * r["wilson_high"].get<double>(),
      r["state"].get<std::string>().c_str(),
      (std::string(r["certified"] == true ? "Can be certified: " : "Cannot be certified: ") +
       r["why"].get<std::string>())
          .c_str());
  std::printf("Next: %s (%s)\n\n", r["next"]["scenario"].get<std::string>().c_str(),
              r["next"]["why"].get<std::string>().c_str());
  for (const auto& s : r["scenarios"])
    std::printf("  %-20s %3ld of %-3ld  %s\n", s["scenario"].get<std::string>().c_str(),
                s["right"].get<long>(), s["trials"].get<long>(),
                s["verdict"].get<std::string>().c_str());
  for (const auto& s : r["scores"])
    if (s.contains("rate"))
      std::printf("  %s: %.1f %% left when trials double (p %.3g)\n",
                  s["score"].get<std::string>().c_str(),
                  100.0 * s["share_left_when_trials_double"].get<double>(),
                  s["rate_p"].is_number() ? s["rate_p"].get<double>() : 1.0);
    else if (s.contains("note"))
      std::printf("  %s: %s\n", s["score"].get<std::string>().c_str(),
                  s["note"].get<std::string>().c_str());
}

Outcome list_all(const assessment::Cohort& cohort, const assessment::Certification& rule,
                 const assessment::TraineeRules& rules, bool json) {
  Json all = Json::array();
  for (std::size_t i = 0; i < cohort.trainees.size(); ++i) {
    auto report = assessment::trainee_report(cohort, i, rule, rules).report;
    if (!json)
      std::printf("%-20s %4ld trials  %3.0f %% right  %-9s  next: %s\n",
                  report["trainee"].get<std::string>().c_str(), report["trials"].get<long>(),
                  100.0 * report["share"].get<double>(), report["state"].get<std::string>().c_str(),
                  report["next"]["scenario"].get<std::string>().c_str());
    all.push_back(std::move(report));
  }
  if (json) std::puts(all.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  return 0;
}

Outcome run_trainee(const TraineeOptions& o) {
  const auto rates = TRY(statistics::Rates::make(o.adequate, o.inadequate));
  const auto table =
      TRY(assessment::Table::read(o.data, o.columns.all(), assessment::Missing::keep));
  const auto cohort = TRY(assessment::cohort_of(table, o.columns));
  const auto rule = assessment::certification(rates);
  const assessment::TraineeRules rules{
      rates, o.threshold > 0.0 ? std::optional(o.threshold) : std::nullopt, o.relapse};
  if (o.who.empty()) return list_all(cohort, rule, rules, o.json);
  const auto at = std::ranges::find(cohort.trainees, o.who);
  if (at == cohort.trainees.end())
    return core::Error{core::Errc::not_found, fmt::format("{}: there is no '{}' in column '{}'",
                                                          o.data, o.who, o.columns.trainee)};
  const auto report = assessment::trainee_report(
      cohort, static_cast<std::size_t>(at - cohort.trainees.begin()), rule, rules);
  if (!o.html.empty()) {
    const std::string page = assessment::trainee_page(report, o.simulated);
    TRY(core::write_file(o.html, core::bytes_of(page)));
  }
  if (o.json)
    std::puts(report.report.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  else
    print_one(report.report);
  return 0;
}

}  // namespace

Command trainee_command() {
  return {"trainee",
          "Report on one trainee: learning curve, competence, strengths, next case; or list all "
          "trainees",
          "tractus trainee --data trials.csv --who S03 --html S03.html\n"
          "  tractus trainee --data trials.csv --id surgeon --order trial_order --score "
          "operation_time_s\n"
          "  where trials.csv has a row per trial: participant,order,scenario,correct,…",
          [](CLI::App& app) {
            auto o = std::make_shared<TraineeOptions>();
            app.add_option("--data", o->data, "CSV file, one row per trial")->required();
            app.add_option("--who", o->who,
                           "name of the trainee (default: all trainees, one line each)");
            app.add_option("--id", o->columns.trainee, "column with the name of the trainee")
                ->capture_default_str();
            app.add_option("--order", o->columns.order,
                           "column with the number of the trial in the trainee's order")
                ->capture_default_str();
            app.add_option("--scenario", o->columns.scenario, "column with the scenario")
                ->capture_default_str();
            app.add_option("--correct", o->columns.right,
                           "column that is 1 if the answer was correct, else 0")
                ->capture_default_str();
            app.add_option("--score", o->columns.scores,
                           "column of a score whose learning curve is fitted; may be repeated");
            app.add_option("--adequate", o->adequate, "failure rate of adequate performance")
                ->capture_default_str();
            app.add_option("--inadequate", o->inadequate, "failure rate of inadequate performance")
                ->capture_default_str();
            app.add_option("--threshold", o->threshold,
                           "threshold h of the LC-CUSUM (default: the threshold that allows the "
                           "earliest certification)")
                ->check(CLI::Range(1e-3, 100.0));
            app.add_option("--relapse", o->relapse,
                           "threshold of the CUSUM sum at which relapse is signalled")
                ->check(CLI::Range(1e-3, 100.0))
                ->capture_default_str();
            app.add_option("--html", o->html, "file for the trainee's report, as an HTML page");
            app.add_flag("--simulated", o->simulated,
                         "the trials are simulated; the report states this");
            app.add_flag("--json", o->json, "print the result as JSON");
            return [o] { return run_trainee(*o); };
          }};
}

}  // namespace commands
}  // namespace tractus
