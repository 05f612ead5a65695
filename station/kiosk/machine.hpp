/// The kiosk's states: what the screen shows, what a person may do there, and when it signs out. It
/// knows no browser, no socket and no device; time is handed to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/clock.hpp"
#include "core/json.hpp"
#include "trial/trial.hpp"
#include "wire/assigned_work.hpp"
#include "wire/trial_result.hpp"

namespace tractus::kiosk {

enum class Screen {
  badge,
  pin,
  checking,   ///< the server looks at badge and PIN
  work,       ///< what is next
  preparing,  ///< case and device are made ready
  running,
  answer,
  saving,
  result,
  paused,
  complete,  ///< nothing is left
  fault,
  technician_pin,
  technician,  ///< the technician's menu
  testing,     ///< a self-test runs
};
constexpr auto words(Screen) {
  using enum Screen;
  return std::to_array<core::Word<Screen>>({{badge, "badge"},
                                            {pin, "pin"},
                                            {checking, "checking"},
                                            {work, "work"},
                                            {preparing, "preparing"},
                                            {running, "running"},
                                            {answer, "answer"},
                                            {saving, "saving"},
                                            {result, "result"},
                                            {paused, "paused"},
                                            {complete, "complete"},
                                            {fault, "fault"},
                                            {technician_pin, "technician_pin"},
                                            {technician, "technician"},
                                            {testing, "testing"}});
}

enum class FaultKind {
  interrupted,  ///< the program or the power ended in the middle of a trial
  timed_out,    ///< nobody touched the screen
  network,      ///< the server does not answer
  locked,       ///< too many wrong PINs
  device,
  emergency_stop,
  stopped,  ///< by a supervisor
  work,     ///< the next trial cannot be done here
};
constexpr auto words(FaultKind) {
  using enum FaultKind;
  return std::to_array<core::Word<FaultKind>>({{interrupted, "interrupted"},
                                               {timed_out, "timed_out"},
                                               {network, "network"},
                                               {locked, "locked"},
                                               {device, "device"},
                                               {emergency_stop, "emergency_stop"},
                                               {stopped, "stopped"},
                                               {work, "work"}});
}
using core::name;

/// What a person does at the screen.
struct Command {
  enum class Kind {
    badge,
    pin,
    back,
    start,
    end_trial,
    answer,
    next,
    pause,
    resume,
    retry,
    sign_out,
    technician,
    self_test,
    confirm,   ///< what the self-test asked for is done
    stop_test  ///< the self-test ends with zero force
  };
  Kind kind = Kind::back;
  std::string text = {};                     ///< badge number or PIN
  std::optional<trial::Answer> answer = {};  ///< of `answer`

  /// A message of the page. Errors: bad_input, which never quotes a PIN.
  static core::Result<Command> from_json(const core::Json& json);
};
constexpr auto words(Command::Kind) {
  using Kind = Command::Kind;
  return std::to_array<core::Word<Kind>>({{Kind::badge, "badge"},
                                          {Kind::pin, "pin"},
                                          {Kind::back, "back"},
                                          {Kind::start, "start"},
                                          {Kind::end_trial, "end_trial"},
                                          {Kind::answer, "answer"},
                                          {Kind::next, "next"},
                                          {Kind::pause, "pause"},
                                          {Kind::resume, "resume"},
                                          {Kind::retry, "retry"},
                                          {Kind::sign_out, "sign_out"},
                                          {Kind::technician, "technician"},
                                          {Kind::self_test, "self_test"},
                                          {Kind::confirm, "confirm"},
                                          {Kind::stop_test, "stop_test"}});
}

/// Without a touch for so long, s.
struct TimeOuts {
  double pin_s = 45.0;
  double idle_s = 120.0;    ///< signed in, between trials
  double answer_s = 600.0;  ///< then the trial is kept without an answer
  double paused_s = 900.0;
  double notice_s = 30.0;  ///< a fault that nobody has to act on
};

/// Badge and PIN on their way to the server.
struct Credentials {
  std::string badge, pin;
};

/// Of the running trial. In a blind trial depth and progress are not shown.
struct Live {
  double t_s = 0.0;
  std::optional<double> depth_m = {}, progress = {};
};

/// What is asked once a trial has ended.
struct Asked {
  trial::Rig rig = trial::Rig::palpation;
  double length_m = 0.0;
};

/// What became of a trial.
struct Outcome {
  std::optional<trial::Answer> answer;
  bool drilled = false;
  bool sent = false;  ///< the server has it; else it waits on this station's disk
  std::optional<wire::TrialResult> result = {};  ///< as the server gives it to the trainee
};

/// One person at one station. The page's commands and the session's events change the screen; what
/// does not fit the screen is refused (Errc::conflict) and changes nothing. Not for several threads.
class Machine {
 public:
  explicit Machine(bool simulated, TimeOuts times = {}) : times_(times), simulated_(simulated) {}

  /// Opens the technician's menu; empty: there is none. After five wrong ones, one try every three
  /// minutes, as the server does with a badge.
  void technician_pin(std::string pin) { technician_pin_ = std::move(pin); }

  /// Participants of a blind study come, not trainees: a pseudonym in place of badge and PIN.
  void of_study() { study_ = true; }

  Screen screen() const noexcept { return screen_; }
  std::optional<FaultKind> fault() const noexcept { return fault_; }
  /// What the page shows: the screen with what belongs to it. Never a PIN.
  core::Json to_json() const;

  /// A command of the page. Errors: conflict, bad_input.
  core::Result<void> take(const Command& command, core::Instant_ns now);
  /// Nobody may have touched the screen for too long. True when the screen changed.
  bool tick(core::Instant_ns now);

  /// Events of the session, which the session's thread tells.
  void interrupted(const std::string& what, core::Instant_ns now);
  /// @param language  that the person chose; empty: none
  void signed_in(const std::string& name, const std::string& language = {});
  void sign_in_refused(const std::string& why, core::Instant_ns now);
  void sign_in_failed(FaultKind kind, const std::string& what, core::Instant_ns now);
  void offered(const wire::AssignedWork& work, core::Instant_ns now);
  void preparing();
  /// Not shown over a pause.
  void running(const Live& live);
  void asked(const Asked& question, core::Instant_ns now);
  void saving();
  void done(const Outcome& outcome, core::Instant_ns now);
  /// Of the trial whose outcome is shown.
  void result(wire::TrialResult result) { outcome_.result = std::move(result); }
  void failed(FaultKind kind, const std::string& what, core::Instant_ns now);
  void complete(core::Instant_ns now);
  /// The device has said that it is simulated, which its name does not always tell.
  void simulated() { simulated_ = true; }
  void waiting(std::uint64_t trials) { waiting_ = trials; }
  /// The device has a button that starts a trial as well as a touch.
  void has_button(bool has) { button_ = has; }
  /// For the technician: what became of this station's trials, the newest first.
  void trials(std::vector<std::string> lines) { trials_ = std::move(lines); }
  /// For the technician: a line of the program's log; the last kMostLines are kept.
  void log(std::string line);
  static constexpr std::size_t kMostLines = 8;
  /// For the technician: version, device, limits.
  void about(core::Json about) { about_ = std::move(about); }
  /// The self-test tells what will move. With `waits` it goes on after `confirm` alone.
  void instruct(const std::string& what, bool waits);
  /// A self-test has ended. @param findings  of the report; empty with `why` there is none
  void tested(core::Json findings, const std::string& why, core::Instant_ns now);
  /// The session has ended: the next person.
  void signed_out(core::Instant_ns now);

  /// What the session asks of the machine.
  std::optional<Credentials> take_credentials();  ///< once
  /// Whether the trainee leaves: the session's rounds end.
  bool leaves() const noexcept { return leaves_; }
  bool ends_trial() const noexcept { return ends_trial_; }
  /// The trainee has paused the running trial.
  bool pauses_trial() const noexcept {
    return screen_ == Screen::paused && before_pause_ == Screen::running;
  }
  bool waits_for_confirmation() const noexcept { return waits_; }
  bool stops_test() const noexcept { return stops_test_; }
  /// In `answer`, after the command; nothing after a time-out.
  const std::optional<trial::Answer>& answer() const noexcept { return answer_; }

 private:
  void show(Screen screen, core::Instant_ns now);
  void show_fault(FaultKind kind, const std::string& what, core::Instant_ns now);
  void forget();
  core::Result<void> not_now(const Command& command) const;
  core::Result<void> take_badge(const Command& command, core::Instant_ns now);
  core::Result<void> take_fault(const Command& command, core::Instant_ns now);
  core::Result<void> leave(core::Instant_ns now);
  core::Result<void> take_pause(const Command& command, core::Instant_ns now);
  void end_paused_trial(core::Instant_ns now);
  core::Result<void> take_technician(const Command& command, core::Instant_ns now);
  void judge_technician(const std::string& pin, core::Instant_ns now);
  bool technician_locked(core::Instant_ns now) const noexcept;
  bool nobody_signed_in() const noexcept { return name_.empty(); }
  double patience_s() const noexcept;

  TimeOuts times_;
  bool simulated_;
  Screen screen_ = Screen::badge, before_pause_ = Screen::work;
  core::Instant_ns touched_ = 0;
  std::optional<FaultKind> fault_;
  std::string what_;    ///< of a fault, for a technician
  std::string notice_;  ///< one line on the screen: why a PIN was refused
  std::string badge_, name_, language_;
  std::optional<Credentials> credentials_;
  std::optional<wire::AssignedWork> work_;
  Live live_;
  Asked asked_;
  std::optional<trial::Answer> answer_;
  Outcome outcome_;
  std::uint64_t waiting_ = 0;
  std::vector<std::string> trials_, log_;
  core::Json about_ = core::Json::object();
  std::string instruction_;  ///< of the self-test
  bool waits_ = false, stops_test_ = false, button_ = false;
  bool study_ = false;
  std::string technician_pin_;
  int wrong_pins_ = 0;
  core::Instant_ns wrong_at_ = 0;
  core::Json findings_ = core::Json::array();
  bool leaves_ = false, ends_trial_ = false, timed_out_ = false;
};

}  // namespace tractus::kiosk
