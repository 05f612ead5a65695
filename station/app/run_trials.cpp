/// The trials themselves: prepare, run, answer, hand over.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/presence.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/session/station.hpp"

namespace tractus {
namespace app {
namespace {
using session::TrialReport;

core::Result<std::shared_ptr<const session::PreparedCase>> prepare(
    const Options& options, const session::StationFolder& folder) {
  if (!options.server_url.empty() && !session::find_case(folder, options.case_name)) {
    if (auto fetched = fetch_cases(options, folder); !fetched)
      std::fprintf(stderr, "warning: cases were not fetched: %s\n", fetched.error().what.c_str());
  }
  const auto model = TRY(model_file_of(options, folder));
  auto made =
      TRY(session::prepare_case(folder, options.case_name, model,
                                core::terminal_progress("Preparing the case"), options.drilled));
  return std::shared_ptr<const session::PreparedCase>(std::move(made));
}

session::Watch palpation_watch(const Options& options, const core::Progress& shown,
                               TrialViewer& onlooker) {
  return [&options, &shown, &onlooker,
          said = std::uint64_t{0}](const session::TrialSnapshot& seen) mutable {
    if (options.follow && seen.samples_safe != said) {
      said = seen.samples_safe;
      fmt::print(stderr, "{}\n",
                 core::Json{{"trial_id", seen.header.id}, {"samples_safe", said}}.dump());
    }
    shown(seen.progress);
    const bool looking = onlooker.look(seen);
    return looking && !asked_to_stop();
  };
}

core::Result<TrialReport> one_trial(const Options& options, Presence& presence,
                                    const session::StationFolder& folder, session::Station& station,
                                    const std::shared_ptr<const session::PreparedCase>& prepared,
                                    const session::TrialSetup& setup, std::uint64_t seed) {
  presence.is(Presence::State::preparing);
  ViewOptions how = look_of(options);
  how.burr = setup.burr;
  auto onlooker = TRY(TrialViewer::make(*prepared, how));
  TRY(station.prepare(prepared, seed));
  onlooker.follow(*station.live());
  say_calibration_due(folder, options.setup.device);
  const core::Progress shown = core::terminal_progress(fmt::format("Trial, seed {}", seed));
  const auto watch = presence.watched(palpation_watch(options, shown, onlooker));
  TRY(station.run(watch));
  presence.is(Presence::State::questions);
  const core::Json headset = onlooker.end_headset();
  if (!headset.is_null()) TRY(station.note(trial::EventKind::headset, headset));
  if (auto left = onlooker.leave_picture(); !left)
    std::fprintf(stderr, "warning: no picture: %s\n", left.error().what.c_str());
  std::optional<trial::Answer> said;
  const bool asks = !options.burr;  // who drills made the channel: there is nothing to guess
  if (station.state() == session::State::answering && asks && !asked_to_stop()) {
    auto answer = TRY(answer_of(options, station.simulated_answer()));
    said = answer;
  }
  auto report = station.answer(said);
  if (report) report->headset = headset;
  if (report) presence.done(*report);
  return report;
}

void print_drilled(const TrialReport::Drilled& drilled) {
  const core::Json& made = drilled.detail;
  fmt::print("  drilled {:.1f} mm3 of bone in {} changes, felt {:.1f} ms later (p99 {:.1f} ms)\n",
             made.at("removed_m3").get<double>() * 1e9, made.at("changes").get<int>(),
             1e3 * drilled.lag_p50_s, 1e3 * drilled.lag_p99_s);
}

/// The burr that was asked for, if one was.
core::Result<std::optional<drilling::Burr>> burr_of(const Options& options) {
  if (!options.burr) return std::optional<drilling::Burr>();
  if (options.burr_file.empty()) return std::optional(drilling::Burr{});
  const auto json = TRY(core::read_json(options.burr_file));
  auto burr = TRY(drilling::Burr::from_json(json, options.burr_file.string()));
  return std::optional(burr);
}

void print_report(const TrialReport& report, bool fast) {
  const trial::TickCounts& n = report.counts;
  const double share = n.samples ? 100.0 * double(n.late) / double(n.samples) : 0.0;
  fmt::print("trial {}{}\n", report.trial_id,
             report.simulated ? "  (SIMULATED hand and device)" : "");
  fmt::print(
      "  {:.1f} s, {} samples, {} late ({:.3f} %), {} skipped, {} not converged, {} limited\n",
      report.duration_s, n.samples, n.late, share, n.skipped, n.not_converged, n.limited);
  if (fast)
    fmt::print("  simulated time, run as fast as it goes; tick p50 {:.0f} us\n",
               report.work_p50_us);
  else
    fmt::print("  wake-up p50 {:.0f} us, p99 {:.0f} us; tick p50 {:.0f} us, p99 {:.0f} us\n",
               report.wake_p50_us, report.wake_p99_us, report.work_p50_us, report.work_p99_us);
  fmt::print("  energy given to the hand beyond what it gave: at most {:.2g} mJ\n",
             1e3 * report.injected_J);
  if (!report.headset.is_null()) fmt::print("  {}\n", headset_text(report.headset));
  if (report.drilled) print_drilled(*report.drilled);
  for (const auto& warning : report.grant.warnings) fmt::print("  warning: {}\n", warning);
  if (!report.fault.empty()) fmt::print("  FAULT: {}\n", report.fault);
  if (!report.drilled) fmt::print("  answer: {}\n", answer_text(report));
  fmt::print("  {}\n", report.file.string());
}

/// After a fault of a machine that a person holds, that person goes on; nobody else does.
bool may_resume(const TrialReport& last) {
  if (last.complete || last.simulated) return true;
  if (!::isatty(STDIN_FILENO)) return false;
  fmt::print(stderr, "Look at the device; plug it in if it was out. Enter goes on, Ctrl-D ends: ");
  std::string line;
  return bool(std::getline(std::cin, line));
}

}  // namespace

core::Result<int> run_trials(const Options& options) {
  const auto burr = TRY(burr_of(options));
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  Presence presence(options, folder);
  presence.is(Presence::State::preparing);
  auto prepared = TRY(prepare(options, folder));

  session::TrialSetup setup = options.setup;
  setup.outside = presence.outside();
  setup.burr = burr;
  session::Station station(folder, setup);
  core::Json trials = core::Json::array();
  bool faulted = false;
  for (int i = 0; i < options.trials && !asked_to_stop() && presence.may_resume(); ++i) {
    auto report = TRY(one_trial(options, presence, folder, station, prepared, setup,
                                options.setup.seed + std::uint64_t(i)));
    faulted = faulted || !report.complete;
    auto scores = TRY(session::scores_of(report.file, &prepared->opened.definition.tract));
    trials.push_back(json_of(report, scores));
    if (!options.json) {
      print_report(report, options.setup.speed == session::Speed::fast);
      print_scores(scores);
    }
    if (i + 1 < options.trials && !may_resume(report)) break;
  }
  const core::Json uploads = hand_over_after(options, folder);
  if (options.json)
    fmt::print(
        "{}\n",
        core::Json{{"case_id", prepared->opened.id}, {"trials", trials}, {"upload", uploads}}.dump(
            2));
  return faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
