/// Trials on the probing rig: a scenario, or a model alone.
#include <fmt/format.h>

#include <cstdio>

#include "core/progress.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/presence.hpp"
#include "station/app/probing.hpp"
#include "station/app/trial_epilogue.hpp"

namespace tractus {
namespace app {
namespace {
using session::ProbingTask;
using session::TrialReport;

constexpr double kModelTravel_m = 0.05;  // of a model that is felt without a scenario

core::Result<ProbingTask> task_of(const Options& options, const session::StationFolder& folder) {
  std::optional<models::ProbingModel> model;
  const auto file = TRY(model_file_of(options, folder));
  if (!file.empty()) {
    auto read = TRY(models::ProbingModel::read(file));
    model = std::move(read);
  }
  if (options.scenario.empty()) return session::task_of(*model, kModelTravel_m);
  auto scenario = TRY(scenario_named(options.scenario));
  return session::task_of(scenario, model);
}

}  // namespace

core::Result<scenarios::Scenario> scenario_named(const std::string& name) {
  if (const auto kind = core::from_name<scenarios::Kind>(name);
      kind && !std::filesystem::exists(name))
    return scenarios::tuned(*kind);
  return scenarios::Scenario::read(name);
}

void print_probing_report(const TrialReport& report, bool fast) {
  const auto& bus = *report.bus;
  const trial::TickCounts& n = report.counts;
  fmt::print("trial {}{}\n", report.trial_id,
             report.simulated ? "  (SIMULATED rig and surgeon)" : "");
  fmt::print(
      "  {:.1f} s, {} samples, {} periods missed, {} skipped, {} without an answer, {} restarts\n",
      report.duration_s, n.samples, n.missed, n.skipped, n.bus_lost, bus.restarts);
  fmt::print("  round trip p50 {:.0f} us, p99 {:.0f} us{}\n", bus.p50_us, bus.p99_us,
             fast ? "; simulated time, run as fast as the bus goes" : "");
  for (const auto& warning : report.grant.warnings) fmt::print("  warning: {}\n", warning);
  if (!report.fault.empty()) fmt::print("  FAULT: {}\n", report.fault);
  fmt::print("  answer: {}\n  {}\n", answer_text(report), report.file.string());
}

namespace {
session::Watch probing_watch(const Options& options) {
  return [&options, said = std::uint64_t{0},
          shown = core::terminal_progress("Trial")](const session::TrialSnapshot& seen) mutable {
    if (options.follow && seen.samples_safe != said) {
      said = seen.samples_safe;
      fmt::print(stderr, "{}\n",
                 core::Json{{"trial_id", seen.header.id}, {"samples_safe", said}}.dump());
    }
    if (!seen.blind) shown(seen.progress);
    return !asked_to_stop();
  };
}

core::Result<TrialReport> one_trial(const Options& options, Presence& presence,
                                    const session::StationFolder& folder, const ProbingTask& task,
                                    std::uint64_t seed) {
  session::RigSetup setup = options.rig;
  setup.seed = seed;
  setup.outside = presence.outside();
  presence.is(Presence::State::preparing);
  auto report = session::run_probing_trial(
      folder, task, setup, warned(presence.watched(probing_watch(options)), folder, setup.device),
      [&](const std::optional<trial::Answer>& simulated)
          -> core::Result<std::optional<trial::Answer>> {
        presence.is(Presence::State::questions);
        if (asked_to_stop()) return std::optional<trial::Answer>();
        return answer_of(options, simulated);
      });
  if (report) presence.done(*report);
  return report;
}
}  // namespace

core::Result<int> run_probing_trials(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  auto task = TRY(task_of(options, folder));

  Presence presence(options, folder);
  core::Json trials = core::Json::array();
  bool faulted = false;
  for (int i = 0; i < options.trials && !asked_to_stop() && presence.may_resume(); ++i) {
    auto report =
        TRY(one_trial(options, presence, folder, task, options.rig.seed + std::uint64_t(i)));
    faulted = faulted || !report.complete;
    auto scores = TRY(session::scores_of(report.file));
    trials.push_back(json_of(report, scores));
    if (options.json) continue;
    print_probing_report(report, options.rig.speed == session::Speed::fast);
    print_scores(scores);
  }
  const core::Json uploads = hand_over_after(options, folder);
  if (options.json)
    fmt::print(
        "{}\n",
        core::Json{{"case_id", task.case_id}, {"trials", trials}, {"upload", uploads}}.dump(2));
  return faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
