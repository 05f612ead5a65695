/// A trainee signs in with badge and PIN at the terminal and does the trials assigned. Nothing that
/// is shown tells which case it is.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/assigned_rounds.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/trial_epilogue.hpp"

namespace tractus {
namespace app {
namespace {

/// From a file, or typed unseen at the terminal.
core::Result<std::string> pin_of(const Options& options) {
  if (!options.pin_file.empty()) return pin_in(options.pin_file);
  if (!::isatty(STDIN_FILENO))
    return core::Error{core::Errc::bad_input, "--pin-file: is needed without a terminal"};
  const char* typed = ::getpass("PIN: ");
  return std::string(typed ? typed : "");
}

/// What is asked of the trainee where that is not plain.
const char* task_text(const wire::AssignedTrial& trial) {
  if (trial.drills) return ": drill the channel";
  return trial.drilled.empty() ? "" : ": feel the channel that you drilled";
}

class AtTerminal final : public Trainee {
 public:
  AtTerminal(const Options& options, Presence& presence) : options_(options), presence_(presence) {}

  bool may_begin() override { return !asked_to_stop() && presence_.may_resume(); }

  bool starts(const wire::AssignedWork& work) override {
    const wire::AssignedTrial& trial = *work.trial;
    if (!options_.json)
      fmt::print("{}: {}, {} of {}{}\n", trial.assignment, trial.name, trial.number, trial.planned,
                 task_text(trial));
    return true;
  }

  bool look(const session::TrialSnapshot&) override { return !asked_to_stop(); }

  core::Result<std::optional<trial::Answer>> answer(
      const Question&, const std::optional<trial::Answer>& simulated) override {
    return answer_of(options_, simulated);
  }

  bool tries_again(Stage, const core::Error&) override { return false; }

  bool goes_on(const wire::AssignedWork&, const session::TrialReport& report, bool) override {
    if (!report.headset.is_null() && !options_.json)
      fmt::print("  {}\n", headset_text(report.headset));
    return report.complete || (presence_.outside()->stopped() && presence_.may_resume());
  }

 private:
  const Options& options_;
  Presence& presence_;
};

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
  AtTerminal trainee(options, presence);
  AssignedTally tally;
  const auto done = do_assigned(options, presence, folder,
                                assigned_work(options, folder, *server, ticket), trainee, tally);
  uplink::sign_out(*server, ticket, tally.unstarted);
  TRY(done);
  if (options.json)
    fmt::print(
        "{}\n",
        core::Json{{"name", ticket.name}, {"trials", tally.trials}, {"left", tally.left}}.dump(2));
  else
    fmt::print("{}: {}\n", ticket.name,
               tally.left == 0 ? "nothing is left to be done"
                               : fmt::format("{} trials are left", tally.left));
  return tally.faulted ? 1 : 0;
}

}  // namespace app
}  // namespace tractus
