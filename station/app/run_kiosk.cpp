/// The kiosk: who comes signs in on the screen and does the trials assigned, as with `assigned`, or
/// those of a blind study, as with `study`.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "core/try.hpp"
#include "station/app/assigned_rounds.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/kiosk_browser.hpp"
#include "station/app/kiosk_technician.hpp"
#include "station/app/start_watch.hpp"
#include "station/app/study_work.hpp"
#include "station/app/trial_epilogue.hpp"
#include "station/devices/catalogue.hpp"
#include "station/kiosk/page_server.hpp"

namespace tractus {
namespace app {
namespace {
using core::Instant_ns;
using kiosk::Desk;
using kiosk::FaultKind;
using kiosk::Machine;
using kiosk::Screen;

constexpr Instant_ns kSendAgain_ns = 30'000'000'000, kAskAgain_ns = 1'000'000'000;
constexpr int kMostAsked = 60;  // a result that has not come by then is seen on the pages

/// To standard error and to the technician's menu.
void log_line(Desk& desk, const std::string& line) {
  std::fprintf(stderr, "warning: %s\n", line.c_str());
  desk.tell([&](Machine& machine, Instant_ns) {
    machine.log(fmt::format("{} {}", core::utc_text(core::utc_us()), line));
  });
}

std::uint64_t trials_waiting(const session::StationFolder& folder) {
  const auto entries = folder.outbox().entries();
  if (!entries) return 0;
  return static_cast<std::uint64_t>(std::ranges::count_if(
      *entries,
      [](const uplink::OutboxEntry& entry) { return entry.state == uplink::OutboxState::queued; }));
}

/// By the words of safety::text_of and of the rig's entry, which the trial's file states as well.
FaultKind kind_of_fault(const std::string& what) {
  return what.find("emergency stop") != std::string::npos ? FaultKind::emergency_stop
                                                          : FaultKind::device;
}

FaultKind kind_of_error(Stage stage, const core::Error& error) {
  const bool absent = error.code == core::Errc::unavailable;
  if (stage == Stage::server) return absent ? FaultKind::network : FaultKind::work;
  const bool of_device = absent || error.code == core::Errc::io;
  return of_device ? kind_of_fault(error.what) : FaultKind::work;
}

bool goes_or_leaves(const Machine& machine) {
  return machine.screen() == Screen::preparing || machine.leaves();
}

/// What every visit to this station shares.
struct Kiosk {
  const Options& options;
  const session::StationFolder& folder;
  uplink::Server& server;
  Presence& presence;
  Desk& desk;
  const core::Clock& clock;
};

class AtKiosk final : public Trainee {
 public:
  /// @param ticket  asks for results; null: they are shown to nobody, as in a blind study
  AtKiosk(const Kiosk& kiosk, const uplink::Ticket* ticket)
      : kiosk_(kiosk), desk_(kiosk.desk), presence_(kiosk.presence), ticket_(ticket) {}

  bool may_begin() override {
    if (!presence_.outside()->stopped()) return stays();
    return overcome(FaultKind::stopped, session::stop_message(*presence_.outside()));
  }

  bool starts(const wire::AssignedWork& work) override {
    presence_.is(Presence::State::idle);
    const auto button = StartWatch::begin(kiosk_.options, [this] {
      static_cast<void>(desk_.take({.kind = kiosk::Command::Kind::start}));
    });
    desk_.tell([&](Machine& machine, Instant_ns now) {
      machine.has_button(button != nullptr);
      machine.offered(work, now);
    });
    return waits_to_go_on();
  }

  bool look(const session::TrialSnapshot& seen) override {
    kiosk::Live live{.t_s = std::max(seen.t_s, 0.0)};
    if (!seen.blind) live.depth_m = seen.depth_m, live.progress = seen.progress;
    desk_.tell([&](Machine& machine, Instant_ns now) {
      if (seen.header.simulated) machine.simulated();
      machine.running(live);
      machine.tick(now);  // of a pause
      presence_.outside()->pause(machine.pauses_trial());
    });
    return !asked_to_stop() && !desk_.look([](const Machine& m) { return m.ends_trial(); });
  }

  core::Result<std::optional<trial::Answer>> answer(const Question& question,
                                                    const std::optional<trial::Answer>&) override {
    presence_.outside()->pause(false);
    desk_.tell([&](Machine& machine, Instant_ns now) {
      machine.asked({question.rig, question.length_m}, now);
    });
    const bool said = desk_.wait(
        [](const Machine& machine) { return machine.screen() == Screen::saving; }, asked_to_stop);
    if (!said) return std::optional<trial::Answer>();
    return desk_.look([](const Machine& machine) { return machine.answer(); });
  }

  bool tries_again(Stage stage, const core::Error& error) override {
    if (presence_.outside()->stopped())
      return overcome(FaultKind::stopped, session::stop_message(*presence_.outside()));
    return overcome(kind_of_error(stage, error), error.what);
  }

  bool goes_on(const wire::AssignedWork& work, const session::TrialReport& report,
               bool sent) override {
    presence_.outside()->pause(false);
    const std::uint64_t waiting = trials_waiting(kiosk_.folder);
    desk_.tell([&](Machine& machine, Instant_ns) { machine.waiting(waiting); });
    if (presence_.outside()->stopped())
      return overcome(FaultKind::stopped, session::stop_message(*presence_.outside()));
    if (!report.complete) return overcome(kind_of_fault(report.fault), report.fault);
    const kiosk::Outcome outcome{report.answer, work.trial->drills, sent};
    desk_.tell([&](Machine& machine, Instant_ns now) { machine.done(outcome, now); });
    if (sent && !work.trial->drills) show_result(report.trial_id);
    return waits_to_go_on();
  }

 private:
  bool stays() const {
    return !asked_to_stop() && !desk_.look([](const Machine& machine) { return machine.leaves(); });
  }
  /// Asks the server until the result is there, the trainee goes on, or it takes too long.
  void show_result(const std::string& trial_id) {
    if (!ticket_) return desk_.tell([](Machine& machine, Instant_ns) { machine.result({}); });
    for (int asked = 0; asked < kMostAsked; ++asked) {
      const auto result = uplink::trial_result(kiosk_.server, *ticket_, trial_id);
      if (!result) return log_line(desk_, "no result was read: " + result.error().what);
      desk_.tell([&](Machine& machine, Instant_ns) { machine.result(*result); });
      if (result->state != wire::ResultState::assessing) return;
      const Instant_ns again = kiosk_.clock.now() + kAskAgain_ns;
      if (desk_.wait(goes_or_leaves,
                     [&] { return asked_to_stop() || kiosk_.clock.now() > again; }) ||
          asked_to_stop())
        return;
    }
  }
  bool waits_to_go_on() { return desk_.wait(goes_or_leaves, asked_to_stop) && stays(); }
  /// A person looks at what is wrong, and says that it goes on.
  bool overcome(FaultKind kind, const std::string& what) {
    log_line(desk_, what);
    desk_.tell([&](Machine& machine, Instant_ns now) { machine.failed(kind, what, now); });
    if (!waits_to_go_on()) return false;
    presence_.resume();
    return true;
  }

  const Kiosk& kiosk_;
  Desk& desk_;
  Presence& presence_;
  const uplink::Ticket* ticket_;
};

void tell_sign_in_error(Desk& desk, const core::Error& error) {
  const auto says = [&](const char* words) { return error.what.find(words) != std::string::npos; };
  desk.tell([&](Machine& machine, Instant_ns now) {
    if (error.code == core::Errc::unauthorised && says("badge or PIN is wrong"))
      machine.sign_in_refused("Badge or PIN is wrong.", now);
    else if (says("the server answers 429"))
      machine.sign_in_failed(FaultKind::locked, error.what, now);
    else
      machine.sign_in_failed(kind_of_error(Stage::server, error), error.what, now);
  });
}

/// That the server is away is no fault.
void send_waiting(const Kiosk& kiosk) {
  if (auto sent = hand_over(kiosk.options, kiosk.folder); !sent)
    log_line(kiosk.desk, "nothing was handed over: " + sent.error().what);
  const std::uint64_t waiting = trials_waiting(kiosk.folder);
  const auto lines = newest_trials(kiosk.folder);
  kiosk.desk.tell([&](Machine& machine, Instant_ns) {
    machine.waiting(waiting);
    machine.trials(lines);
  });
}

bool someone_acts(const Machine& machine) {
  return machine.screen() == Screen::checking || machine.screen() == Screen::testing;
}

/// Until `done` holds; meanwhile what waits is sent again and again. False when the program is to
/// end.
bool wait_and_send(const Kiosk& kiosk, const std::function<bool(const Machine&)>& done) {
  while (!asked_to_stop()) {
    const bool waits = trials_waiting(kiosk.folder) > 0;
    const Instant_ns again = kiosk.clock.now() + kSendAgain_ns;
    if (kiosk.desk.wait(done,
                        [&] { return asked_to_stop() || (waits && kiosk.clock.now() > again); }))
      return true;
    if (!asked_to_stop()) send_waiting(kiosk);
  }
  return false;
}

/// Nothing when the program is to end.
std::optional<kiosk::Credentials> next_credentials(const Kiosk& kiosk) {
  while (wait_and_send(kiosk, someone_acts)) {
    if (kiosk.desk.look([](const Machine& m) { return m.screen() == Screen::testing; })) {
      test_for_technician(kiosk.options, kiosk.folder, kiosk.presence, kiosk.desk);
      continue;
    }
    std::optional<kiosk::Credentials> out;
    kiosk.desk.tell([&](Machine& machine, Instant_ns) { out = machine.take_credentials(); });
    if (out) return out;
  }
  return std::nullopt;
}

/// Somebody who is signed in, until they have signed out.
void do_trials(const Kiosk& kiosk, const NextWork& next, const uplink::Ticket* ticket) {
  AtKiosk trainee(kiosk, ticket);
  AssignedTally tally;
  const auto done = do_assigned(kiosk.options, kiosk.presence, kiosk.folder, next, trainee, tally);
  if (!done) log_line(kiosk.desk, done.error().what);
  const bool left = kiosk.desk.look([](const Machine& machine) { return machine.leaves(); });
  if (done && !left && !asked_to_stop()) {
    kiosk.desk.tell([](Machine& machine, Instant_ns now) { machine.complete(now); });
    wait_and_send(kiosk, [](const Machine& machine) { return machine.leaves(); });
  }
  if (ticket) uplink::sign_out(kiosk.server, *ticket, tally.unstarted);
  const auto lines = newest_trials(kiosk.folder);
  kiosk.desk.tell([&](Machine& machine, Instant_ns) { machine.trials(lines); });
  kiosk.presence.is(Presence::State::idle);
  kiosk.desk.tell([](Machine& machine, Instant_ns now) { machine.signed_out(now); });
}

/// A participant has a pseudonym and no PIN; what there is to do is on the disk from then on.
void visit_of_participant(const Kiosk& kiosk, const std::string& participant) {
  const auto next = [&](bool) { return next_of_study(kiosk.options, kiosk.folder, participant); };
  const auto first = next(true);
  if (!first && first.error().code == core::Errc::not_found)
    return kiosk.desk.tell([](Machine& machine, Instant_ns now) {
      machine.sign_in_refused("No participant of this study has that number.", now);
    });
  if (!first) return tell_sign_in_error(kiosk.desk, first.error());
  kiosk.desk.tell([&](Machine& machine, Instant_ns) { machine.signed_in(participant); });
  do_trials(kiosk, next, nullptr);
}

void visit_of_trainee(const Kiosk& kiosk, const kiosk::Credentials& credentials) {
  auto ticket = uplink::sign_in(kiosk.server, credentials.badge, credentials.pin);
  if (!ticket) return tell_sign_in_error(kiosk.desk, ticket.error());
  kiosk.desk.tell(
      [&](Machine& machine, Instant_ns) { machine.signed_in(ticket->name, ticket->language); });
  do_trials(kiosk, assigned_work(kiosk.options, kiosk.folder, kiosk.server, *ticket), &*ticket);
}

/// One person, from badge to sign-out.
void visit(const Kiosk& kiosk, const kiosk::Credentials& credentials) {
  if (kiosk.options.study.empty())
    visit_of_trainee(kiosk, credentials);
  else
    visit_of_participant(kiosk, credentials.badge);
}

void tell_recovered(Desk& desk, const session::Recovered& recovered) {
  if (recovered.trials.empty()) return;
  std::uint64_t samples = 0;
  for (const auto& one : recovered.trials) samples += one.samples;
  desk.tell([&](Machine& machine, Instant_ns now) {
    machine.interrupted(fmt::format("trials: {}, samples: {}", recovered.trials.size(), samples),
                        now);
  });
}

void print_address(const Options& options, const std::string& address) {
  if (options.json)
    fmt::print("{}\n", core::Json{{"address", address}}.dump());
  else
    fmt::print("{}\n", address);
  std::fflush(stdout);
}

}  // namespace

core::Result<int> run_kiosk(const Options& given) {
  Options options = given;
  options.trials = std::numeric_limits<int>::max();
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto recovered = TRY(folder.recover());
  say_recovered(recovered);
  auto server = TRY(connect(options));
  const core::MonotonicClock clock;
  const kiosk::TimeOuts times{.idle_s = options.idle_s};
  Desk desk(clock, Machine(devices::is_simulated(options.setup.device), times));
  if (!options.study.empty()) desk.tell([](Machine& machine, Instant_ns) { machine.of_study(); });
  if (!options.technician_pin_file.empty()) {
    const std::string pin = TRY(pin_in(options.technician_pin_file));
    if (pin.size() < 4 || pin.size() > 12 || pin.find_first_not_of("0123456789") != pin.npos)
      return core::bad_input(fmt::format("--technician-pin-file {}: 4 to 12 digits are expected",
                                         options.technician_pin_file.string()));
    desk.tell([&](Machine& machine, Instant_ns) { machine.technician_pin(pin); });
  }
  desk.tell([about = about_station(options, folder)](Machine& machine, Instant_ns) {
    machine.about(about);
  });
  tell_recovered(desk, recovered);
  auto pages = TRY(kiosk::PageServer::open(desk, options.web, options.port));
  std::unique_ptr<KioskBrowser> browser;
  if (options.no_browser)
    print_address(options, pages->address());
  else
    browser = TRY(KioskBrowser::start(options.browser, options.data / "kiosk", pages->address()));
  Presence presence(options, folder);
  const Kiosk kiosk{options, folder, *server, presence, desk, clock};
  send_waiting(kiosk);
  while (const auto credentials = next_credentials(kiosk)) visit(kiosk, *credentials);
  return 0;
}

}  // namespace app
}  // namespace tractus
