/// A trainee's assigned trials, one after the other, each as the server gives it.
#include "station/app/assigned_rounds.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/exchange.hpp"
#include "station/devices/catalogue.hpp"
#include "station/session/station.hpp"
#include "study/sealed_law.hpp"

namespace tractus {
namespace app {
namespace {
using session::TrialReport;
using wire::AssignedTrial;
using wire::AssignedWork;

/// What the functions of one round share.
struct Round {
  const Options& options;
  Presence& presence;
  const session::StationFolder& folder;
  Trainee& trainee;
  AssignedTally& tally;
  int number = 0;  ///< of this call, from 0
};

/// The case, with the channel that the trainee drilled if that is what is felt.
core::Result<std::shared_ptr<const session::PreparedCase>> prepare_assigned(
    const Options& options, const session::StationFolder& folder, const AssignedTrial& trial) {
  if (!session::find_case(folder, trial.case_id)) TRY(fetch_cases(options, folder));
  auto made = session::prepare_case(folder, trial.case_id, {},
                                    core::terminal_progress("Preparing the case"), trial.drilled);
  const bool lost = !made && made.error().code == core::Errc::not_found;
  if (lost && !trial.drilled.empty() && session::find_case(folder, trial.case_id))
    return core::Error{
        core::Errc::not_found,
        fmt::format("the channel that trial {} drilled is not on this station's disk "
                    "any more: have this trainee's trial freed, to drill it anew",
                    trial.drilled)};
  if (!made) return made.error();
  if ((*made)->opened.definition.planned && !trial.drills && trial.drilled.empty())
    return core::Error{
        core::Errc::bad_input,
        "the next trial is of whole bone, which is drilled first: the server does not "
        "know of drilling yet"};
  return std::shared_ptr<const session::PreparedCase>(std::move(*made));
}

/// One trial on a case: the burr makes the channel, or the probe feels one and its walls are asked
/// for.
core::Result<TrialReport> work_on_bone(const Round& round, const AssignedWork& work) {
  const auto& [options, presence, folder, trainee, tally, number] = round;
  const AssignedTrial& trial = *work.trial;
  const auto made = TRY(prepare_assigned(options, folder, trial));
  const std::shared_ptr<const session::PreparedCase>& prepared = made;
  session::TrialSetup setup = options.setup;
  setup.case_known_as = trial.slot;
  setup.operator_name = work.participant;
  setup.outside = presence.outside();
  setup.started_utc_us = started_of(options, number);
  if (trial.drills) setup.burr = drilling::Burr{};
  session::Station station(folder, setup);
  auto onlooker = TRY(TrialViewer::make(*prepared, look_of(options)));
  TRY(station.prepare(prepared, options.setup.seed + trial.number));
  onlooker.follow(*station.live());
  say_calibration_due(folder, options.setup.device);
  const auto watch = [&round, &onlooker](const session::TrialSnapshot& seen) {
    const bool looking = onlooker.look(seen);
    return round.trainee.look(seen) && looking;
  };
  TRY(station.run(presence.watched(watch)));
  presence.is(Presence::State::questions);
  const core::Json headset = onlooker.end_headset();
  if (!headset.is_null()) TRY(station.note(trial::EventKind::headset, headset));
  std::optional<trial::Answer> said;
  const bool asks = !trial.drills;  // who drills made the channel: there is nothing to guess
  if (station.state() == session::State::answering && asks && !asked_to_stop()) {
    const double length_m = prepared->opened.definition.tract.length_m;
    auto answer = TRY(trainee.answer({trial.rig, length_m}, station.simulated_answer()));
    said = answer;
  }
  auto report = station.answer(said);
  if (report) report->headset = headset;
  return report;
}

core::Result<TrialReport> probe(const Round& round, const AssignedWork& work) {
  const auto& [options, presence, folder, trainee, tally, number] = round;
  auto token = TRY(token_of(options));
  const study::StationKey key(core::sha256(core::bytes_of(token)));
  const AssignedTrial& trial = *work.trial;
  auto law = TRY(study::opened_law(trial.sealed, trial.slot, key));
  session::ProbingTask task;
  task.case_id = trial.slot;
  task.law = std::move(law);
  task.operator_name = work.participant;
  task.extra = {{"number", trial.number}};
  if (!options.study.empty()) task.extra["study"] = options.study;
  task.blind = true;
  session::RigSetup setup = options.rig;
  setup.device = options.setup.device;
  setup.speed = options.setup.speed;
  setup.seed = options.setup.seed + trial.number;
  setup.started_utc_us = started_of(options, number);
  setup.outside = presence.outside();
  const auto watch = [&round](const session::TrialSnapshot& seen) {
    return round.trainee.look(seen);
  };
  const double length_m = task.law.travel_m;
  return session::run_probing_trial(
      folder, task, setup, warned(presence.watched(watch), folder, setup.device),
      [&](const std::optional<trial::Answer>& simulated) {
        round.presence.is(Presence::State::questions);
        return round.trainee.answer({trial::Rig::probing, length_m}, simulated);
      });
}

core::Result<TrialReport> run_assigned_trial(const Round& round, const AssignedWork& work) {
  round.presence.is(Presence::State::preparing);
  const std::string& device = round.options.setup.device;
  const bool probing = work.trial->rig == trial::Rig::probing;
  if (devices::is_rig(device) != probing)
    return core::Error{core::Errc::bad_input,
                       fmt::format("the next trial is for {}: --device {} is not for that",
                                   trial::name(work.trial->rig), device)};
  round.tally.unstarted.clear();
  auto report = probing ? probe(round, work) : work_on_bone(round, work);
  if (report) round.presence.done(*report);
  return report;
}

/// The server has every trial before it is asked for the next: else it would give the same again.
core::Result<void> hand_over_all(const Options& options, const session::StationFolder& folder) {
  const auto report = TRY(hand_over(options, folder));
  if (report.waiting == 0) return {};
  return core::Error{core::Errc::unavailable, text_of(report)};
}

/// `work` until it is done, or the trainee does not try again.
template <class Work>
auto tried(Trainee& trainee, Stage stage, const Work& work) {
  for (;;) {
    auto outcome = work();
    if (outcome || !trainee.tries_again(stage, outcome.error())) return outcome;
  }
}

}  // namespace

NextWork assigned_work(const Options& options, const session::StationFolder& folder,
                       uplink::Server& server, const uplink::Ticket& ticket) {
  return [&](bool all_sent) -> core::Result<AssignedWork> {
    if (!all_sent) TRY(hand_over_all(options, folder));
    return uplink::next_trial(server, ticket);
  };
}

core::Result<void> do_assigned(const Options& options, Presence& presence,
                               const session::StationFolder& folder, const NextWork& next,
                               Trainee& trainee, AssignedTally& tally) {
  bool sent = true;
  for (int i = 0; trainee.may_begin(); ++i) {
    const Round round{options, presence, folder, trainee, tally, i};
    auto work = TRY(tried(trainee, Stage::server, [&] { return next(sent); }));
    tally.left = work.left;
    if (!work.trial) return {};
    const AssignedTrial& trial = *work.trial;
    // A channel that was drilled here is felt here.
    if (trial.drilled.empty()) tally.unstarted = trial.slot;
    if (i == options.trials || !trainee.starts(work)) return {};
    auto report =
        TRY(tried(trainee, Stage::trial, [&] { return run_assigned_trial(round, work); }));
    tally.trials.push_back({{"trial_id", report.trial_id},
                            {"number", trial.number},
                            {"name", trial.name},
                            {"tool", trial.drills ? "burr" : "probe"},
                            {"complete", report.complete},
                            {"fault", report.fault}});
    if (!report.headset.is_null()) tally.trials.back()["headset"] = report.headset;
    tally.faulted = !report.complete;
    sent = bool(hand_over_all(options, folder));
    if (!trainee.goes_on(work, report, sent)) return {};
  }
  return {};
}

}  // namespace app
}  // namespace tractus
