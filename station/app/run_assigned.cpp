/// A trainee signs in with badge and PIN and does the trials assigned, one after the other, each as
/// the server gives it. Nothing that is shown tells which case it is.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/presence.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/devices/catalogue.hpp"
#include "station/session/station.hpp"
#include "station/uplink/assigned.hpp"
#include "study/sealed_law.hpp"

namespace tractus {
namespace app {
namespace {
using session::TrialReport;
using wire::AssignedTrial;
using wire::AssignedWork;

/// From a file, or typed unseen at the terminal.
core::Result<std::string> pin_of(const Options& options) {
  if (!options.pin_file.empty()) {
    auto bytes = TRY(core::read_file(options.pin_file, 4096));
    std::string pin(core::text_of(bytes));
    return pin.substr(0, pin.find_first_of("\r\n"));
  }
  if (!::isatty(STDIN_FILENO))
    return core::Error{core::Errc::bad_input, "--pin-file: is needed without a terminal"};
  const char* typed = ::getpass("PIN: ");
  return std::string(typed ? typed : "");
}

bool stopped_by_hand() { return asked_to_stop(); }

/// The case, with the channel that the trainee drilled if that is what is felt.
core::Result<std::shared_ptr<const session::PreparedCase>> prepare(
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
core::Result<TrialReport> work_on_bone(const Options& options, Presence& presence,
                                       const session::StationFolder& folder,
                                       const AssignedWork& work, int number) {
  const AssignedTrial& trial = *work.trial;
  const auto made = TRY(prepare(options, folder, trial));
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
  const auto watch = [&](const session::TrialSnapshot& seen) {
    return onlooker.look(seen) && !stopped_by_hand();
  };
  TRY(station.run(presence.watched(watch)));
  presence.is(Presence::State::questions);
  const core::Json headset = onlooker.end_headset();
  if (!headset.is_null()) TRY(station.note(trial::EventKind::headset, headset));
  std::optional<trial::Answer> said;
  const bool asks = !trial.drills;  // who drills made the channel: there is nothing to guess
  if (station.state() == session::State::answering && asks && !stopped_by_hand()) {
    auto answer = TRY(answer_of(options, station.simulated_answer()));
    said = answer;
  }
  auto report = station.answer(said);
  if (report) report->headset = headset;
  return report;
}

core::Result<TrialReport> probe(const Options& options, Presence& presence,
                                const session::StationFolder& folder, const AssignedWork& work,
                                int number) {
  auto token = TRY(token_of(options));
  const study::StationKey key(core::sha256(core::bytes_of(token)));
  const AssignedTrial& trial = *work.trial;
  auto law = TRY(study::opened_law(trial.sealed, trial.slot, key));
  session::ProbingTask task;
  task.case_id = trial.slot;
  task.law = std::move(law);
  task.operator_name = work.participant;
  task.extra = {{"number", trial.number}};
  task.blind = true;
  session::RigSetup setup = options.rig;
  setup.device = options.setup.device;
  setup.speed = options.setup.speed;
  setup.seed = options.setup.seed + trial.number;
  setup.started_utc_us = started_of(options, number);
  setup.outside = presence.outside();
  const auto watch = [](const session::TrialSnapshot&) { return !stopped_by_hand(); };
  return session::run_probing_trial(folder, task, setup,
                                    warned(presence.watched(watch), folder, setup.device),
                                    [&](const std::optional<trial::Answer>& simulated) {
                                      presence.is(Presence::State::questions);
                                      return answer_of(options, simulated);
                                    });
}

core::Result<TrialReport> one_trial(const Options& options, Presence& presence,
                                    const session::StationFolder& folder, const AssignedWork& work,
                                    int number) {
  presence.is(Presence::State::preparing);
  const std::string& device = options.setup.device;
  const bool probing = work.trial->rig == trial::Rig::probing;
  if (devices::is_rig(device) != probing)
    return core::Error{core::Errc::bad_input,
                       fmt::format("the next trial is for {}: --device {} is not for that",
                                   trial::name(work.trial->rig), device)};
  auto report = probing ? probe(options, presence, folder, work, number)
                        : work_on_bone(options, presence, folder, work, number);
  if (report) presence.done(*report);
  return report;
}

/// What is asked of the trainee where that is not plain.
const char* task_of(const AssignedTrial& trial) {
  if (trial.drills) return ": drill the channel";
  return trial.drilled.empty() ? "" : ": feel the channel that you drilled";
}

/// What was done and what is left.
struct Tally {
  core::Json trials = core::Json::array();
  std::uint64_t left = 0;
  bool faulted = false;
};

/// One after the other; the server has each before it gives the next.
core::Result<Tally> rounds(const Options& options, Presence& presence,
                           const session::StationFolder& folder, uplink::Server& server,
                           const uplink::Ticket& ticket) {
  Tally tally;
  for (int i = 0; !stopped_by_hand() && presence.may_resume(); ++i) {
    auto work = TRY(uplink::next_trial(server, ticket));
    tally.left = work.left;
    if (!work.trial || i == options.trials) return tally;
    const AssignedTrial& trial = *work.trial;
    if (!options.json)
      fmt::print("{}: {}, {} of {}{}\n", trial.assignment, trial.name, trial.number, trial.planned,
                 task_of(trial));
    auto report = TRY(one_trial(options, presence, folder, work, i));
    tally.trials.push_back({{"trial_id", report.trial_id},
                            {"number", trial.number},
                            {"name", trial.name},
                            {"tool", trial.drills ? "burr" : "probe"},
                            {"complete", report.complete},
                            {"fault", report.fault}});
    if (!report.headset.is_null()) {
      tally.trials.back()["headset"] = report.headset;
      if (!options.json) fmt::print("  {}\n", headset_text(report.headset));
    }
    tally.faulted = !report.complete;
    TRY(hand_over(options, folder));
    const bool stopped = presence.outside()->stopped();
    if (tally.faulted && !(stopped && presence.may_resume()))
      return tally;  // a person looks at the device first
  }
  return tally;
}

}  // namespace

core::Result<int> run_assigned(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  auto pin = TRY(pin_of(options));
  auto server = TRY(connect(options));
  TRY(hand_over(options, folder));
  auto ticket = TRY(uplink::sign_in(*server, options.badge, pin));
  Presence presence(options, folder);
  auto tally = rounds(options, presence, folder, *server, ticket);
  uplink::sign_out(*server, ticket);
  if (!tally) return tally.error();
  if (options.json)
    fmt::print(
        "{}\n",
        core::Json{{"name", ticket.name}, {"trials", tally->trials}, {"left", tally->left}}.dump(
            2));
  else
    fmt::print("{}: {}\n", ticket.name,
               tally->left == 0 ? "nothing is left to be done"
                                : fmt::format("{} trials are left", tally->left));
  return tally->faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
