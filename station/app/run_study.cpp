/// A participant's trials of a blind study: taken from the server, or from the disk while it is
/// away. Nothing that is shown, written or named here tells which scenario a trial is.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/presence.hpp"
#include "station/app/study_work.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/rig/surgeon.hpp"
#include "station/session/study_plan.hpp"
#include "study/sealed_law.hpp"

namespace tractus {
namespace app {
namespace {
using session::TrialReport;
using wire::SealedTrial;
using wire::StudyWork;

/// What the command works with.
struct Study {
  const Options& options;
  const session::StationFolder& folder;
  study::StationKey key;
  Presence& presence;
  core::Json trials = core::Json::array();
};

core::Result<study::StationKey> key_of(const Options& options) {
  auto token = TRY(token_of(options));
  return study::StationKey(core::sha256(core::bytes_of(token)));
}

/// Different for every trial, the same when the same trial is done again.
std::uint64_t seed_of(const Options& options, const StudyWork& work, const SealedTrial& trial) {
  const std::string text =
      fmt::format("{}/{}/{}/{}", options.rig.seed, work.study, work.participant, trial.number);
  return std::stoull(core::sha256(core::bytes_of(text)).substr(0, 13), nullptr, 16);
}

std::optional<double> number_typed(const char* question, double most) {
  fmt::print(stderr, "{}", question);
  std::string line;
  if (!std::getline(std::cin, line) || line.empty()) return std::nullopt;
  char* end = nullptr;
  const double value = std::strtod(line.c_str(), &end);
  return end != line.c_str() && value >= 0.0 && value <= most ? std::optional(value) : std::nullopt;
}

/// The study's questions, at the terminal.
std::optional<trial::Answer> asked() {
  if (!::isatty(STDIN_FILENO)) return std::nullopt;
  std::string line;
  do {
    fmt::print(stderr, "Did you feel a breach? yes or no: ");
    if (!std::getline(std::cin, line)) return std::nullopt;
  } while (line != "yes" && line != "no");
  trial::Answer out{.breach = line == "yes", .wall = {}, .confidence = {}};
  if (out.breach) {
    const auto depth_mm = number_typed("Where? Depth in mm, or Enter: ", 200.0);
    if (depth_mm) out.depth_m = *depth_mm * 1e-3;
  }
  const auto percent = number_typed("How sure, 0 to 100? ", 100.0);
  if (percent) out.confidence = *percent * 1e-2;
  return out;
}

session::Watch study_watch(const Options& options) {
  return [&options, said = std::uint64_t{0}](const session::TrialSnapshot& seen) mutable {
    if (options.follow && seen.samples_safe != said) {
      said = seen.samples_safe;
      fmt::print(stderr, "{}\n",
                 core::Json{{"trial_id", seen.header.id}, {"samples_safe", said}}.dump());
    }
    return !asked_to_stop();
  };
}

core::Result<TrialReport> one_trial(const Study& study, const StudyWork& work,
                                    const SealedTrial& trial) {
  auto law = TRY(study::opened_law(trial.sealed, trial.slot, study.key));
  session::ProbingTask task;
  task.case_id = trial.slot;
  task.law = std::move(law);
  task.operator_name = work.participant;
  task.extra = {{"study", work.study}, {"number", trial.number}};
  task.blind = true;
  session::RigSetup setup = study.options.rig;
  setup.outside = study.presence.outside();
  study.presence.is(Presence::State::preparing);
  setup.seed = seed_of(study.options, work, trial);
  setup.started_utc_us = started_of(study.options, std::int64_t(study.trials.size()));
  if (work.simulated && !study.options.skill_given)
    setup.skill = rig::SurgeonParameters::skill_of_experience(work.experience_years.value_or(0.0));
  auto report = session::run_probing_trial(
      study.folder, task, setup,
      warned(study.presence.watched(study_watch(study.options)), study.folder, setup.device),
      [&](const std::optional<trial::Answer>& simulated)
          -> core::Result<std::optional<trial::Answer>> {
        study.presence.is(Presence::State::questions);
        if (asked_to_stop()) return std::optional<trial::Answer>();
        return simulated ? simulated : asked();
      });
  if (report) study.presence.done(*report);
  return report;
}

/// Duration, samples and answer tell a person what they did, and no number tells what it was.
void note(Study& study, const StudyWork& work, const SealedTrial& trial,
          const TrialReport& report) {
  study.trials.push_back({{"trial_id", report.trial_id},
                          {"number", trial.number},
                          {"samples", report.counts.samples},
                          {"complete", report.complete},
                          {"fault", report.fault}});
  if (study.options.json) return;
  fmt::print("{}{}: trial {} of {} is recorded, {} samples{}\n", work.participant,
             report.simulated ? " (SIMULATED)" : "", trial.number, work.planned,
             report.counts.samples, report.fault.empty() ? "" : "  FAULT: " + report.fault);
  std::fflush(stdout);
}

/// The server is told in passing; that it is away is no failure.
core::Json handed(const Study& study) {
  auto report = hand_over(study.options, study.folder);
  if (report) return report->to_json();
  fmt::print(stderr, "warning: nothing was handed over: {}\n", report.error().what);
  return {{"why", report.error().what}};
}

/// Rounds of trials until nothing is left, the line is cut, or somebody stops it. What came back
/// not counting is in the next round. Returns what is still to be done.
core::Result<std::uint64_t> rounds(Study& study, bool& faulted) {
  int left = study.options.trials;
  while (true) {
    handed(study);
    const auto [work, away] = TRY(study_part(study.options, study.folder, study.options.participant,
                                             study.options.rig.device));
    auto todo = TRY(session::still_to_do(study.folder, work));
    for (const SealedTrial& trial : todo) {
      if (left == 0 || asked_to_stop() || !study.presence.may_resume()) return todo.size();
      auto report = TRY(one_trial(study, work, trial));
      note(study, work, trial, report);
      handed(study);
      --left;
      faulted = !report.complete;
      if (faulted && study.presence.outside()->stopped() && study.presence.may_resume()) break;
      if (faulted) return todo.size();  // a person looks at the rig first
    }
    if (todo.empty() || away) return away ? 0 : work.unfinished;
  }
}

}  // namespace

core::Result<int> run_study(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  auto key = TRY(key_of(options));
  TRY(connect(options));  // of no shape: said once
  Presence presence(options, folder);
  Study study{options, folder, key, presence};
  bool faulted = false;
  auto left = TRY(rounds(study, faulted));
  const core::Json upload = handed(study);
  if (options.json)
    fmt::print("{}\n", core::Json{{"study", options.study},
                                  {"participant", options.participant},
                                  {"trials", study.trials},
                                  {"left", left},
                                  {"upload", upload}}
                           .dump(2));
  else
    fmt::print("{}: {}\n", options.participant,
               left == 0 ? "nothing is left to be done" : fmt::format("{} trials are left", left));
  if (const auto waiting = upload.value("waiting", 0); waiting > 0 && !options.json)
    fmt::print("{} trials wait for the server\n", waiting);
  return faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
