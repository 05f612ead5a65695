#include "station/kiosk/machine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "trial/tool.hpp"
#include "volume/tract.hpp"

namespace tractus {
namespace kiosk {
namespace {
using Kind = Command::Kind;
using volume::Wall;
constexpr std::size_t kMostBadge = 64, kMostPin = 12;
constexpr int kMostWrongPins = 5;  // as the server's for badges
constexpr core::Instant_ns kLocked_ns = 180'000'000'000;

core::Json json_of(const wire::AssignedWork& work) {
  const wire::AssignedTrial& trial = *work.trial;
  const auto tool = trial.drills ? trial::Tool::burr : trial::Tool::probe;
  return {{"assignment", trial.assignment},
          {"name", trial.name},
          {"number", trial.number},
          {"planned", trial.planned},
          {"left", work.left},
          {"rig", name(trial.rig)},
          {"tool", name(tool)}};
}

core::Json json_of(const Live& live) {
  core::Json out{{"t_s", live.t_s}, {"depth_m", nullptr}, {"progress", nullptr}};
  if (live.depth_m) out["depth_m"] = *live.depth_m;
  if (live.progress) out["progress"] = *live.progress;
  return out;
}

core::Json json_of(const Outcome& outcome) {
  return {{"answer", outcome.answer ? outcome.answer->to_json() : core::Json()},
          {"drilled", outcome.drilled},
          {"sent", outcome.sent},
          {"result", outcome.result ? outcome.result->to_json() : core::Json()}};
}

bool is_pin(const std::string& text) {
  return !text.empty() && text.size() <= kMostPin &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_badge(const std::string& text) {
  return !text.empty() && std::ranges::none_of(text, [](unsigned char c) { return c < 0x20; });
}
}  // namespace

core::Result<Command> Command::from_json(const core::Json& json) {
  core::Fields fields(json, "command");
  Command out;
  out.kind = fields.word<Kind>("command");
  if (out.kind == Kind::badge) out.text = fields.text("badge", kMostBadge);
  if (out.kind == Kind::pin) out.text = fields.text("pin", kMostPin);
  const core::Json* answer = out.kind == Kind::answer ? fields.member("answer") : nullptr;
  TRY(fields.done());
  if (!answer) return out;
  auto given = TRY(trial::Answer::from_json(*answer, "command: /answer"));
  if (given.wall && !core::from_name<Wall>(*given.wall))
    return core::bad_input(fmt::format("command: /answer/wall {}: one of {} is expected",
                                       *given.wall, core::names_listed<Wall>()));
  out.answer = std::move(given);
  return out;
}

core::Json Machine::to_json() const {
  core::Json out{{"screen", name(screen_)},
                 {"simulated", simulated_},
                 {"name", name_},
                 {"notice", notice_},
                 {"waiting_trials", waiting_}};
  if (work_ && work_->trial) out["work"] = json_of(*work_);
  if (!technician_pin_.empty()) out["technician"] = true;
  if (study_) out["study"] = true;
  if (screen_ == Screen::badge && !notice_.empty()) out["refused_badge"] = badge_;
  if (!language_.empty()) out["language"] = language_;
  if (screen_ == Screen::work) out["button"] = button_;
  if (screen_ == Screen::paused) out["in_trial"] = pauses_trial();
  if (screen_ == Screen::technician)
    out["findings"] = findings_, out["trials"] = trials_, out["log"] = log_, out["about"] = about_;
  if (screen_ == Screen::testing) out["test"] = {{"text", instruction_}, {"waits", waits_}};
  if (screen_ == Screen::running) out["live"] = json_of(live_);
  if (screen_ == Screen::answer)
    out["question"] = {{"rig", name(asked_.rig)}, {"length_m", asked_.length_m}};
  if (screen_ == Screen::result) out["outcome"] = json_of(outcome_);
  if (screen_ == Screen::fault)
    out["fault"] = {{"kind", name(*fault_)}, {"what", what_}, {"signed_in", !nobody_signed_in()}};
  return out;
}

void Machine::show(Screen screen, core::Instant_ns now) {
  screen_ = screen;
  touched_ = now;
  notice_.clear();
  fault_.reset();
}

void Machine::show_fault(FaultKind kind, const std::string& what, core::Instant_ns now) {
  show(Screen::fault, now);
  fault_ = kind;
  what_ = what;
}

void Machine::forget() {
  badge_.clear();
  name_.clear();
  language_.clear();
  credentials_.reset();
  work_.reset();
  answer_.reset();
  leaves_ = ends_trial_ = timed_out_ = false;
}

core::Result<void> Machine::not_now(const Command& command) const {
  return core::Error{core::Errc::conflict,
                     fmt::format("{}: not on the screen {}", name(command.kind), name(screen_))};
}

core::Result<void> Machine::take_badge(const Command& command, core::Instant_ns now) {
  const bool free = screen_ == Screen::badge || screen_ == Screen::pin ||
                    (screen_ == Screen::fault && nobody_signed_in());
  if (!free) return not_now(command);
  if (!is_badge(command.text)) return core::bad_input("badge: a number of a badge is expected");
  forget();
  badge_ = command.text;
  if (study_) credentials_ = Credentials{badge_, ""};
  show(study_ ? Screen::checking : Screen::pin, now);
  return {};
}

/// The rounds end at their next question; until then the screen stays.
core::Result<void> Machine::leave(core::Instant_ns now) {
  touched_ = now;
  leaves_ = true;
  return {};
}

core::Result<void> Machine::take_fault(const Command& command, core::Instant_ns now) {
  if (nobody_signed_in()) {
    if (command.kind != Kind::back) return not_now(command);
    forget();
    show(Screen::badge, now);
    return {};
  }
  if (command.kind == Kind::sign_out) return leave(now);
  if (command.kind != Kind::retry) return not_now(command);
  show(Screen::preparing, now);
  return {};
}

bool Machine::technician_locked(core::Instant_ns now) const noexcept {
  return wrong_pins_ >= kMostWrongPins && now - wrong_at_ < kLocked_ns;
}

void Machine::judge_technician(const std::string& pin, core::Instant_ns now) {
  if (pin == technician_pin_) {
    wrong_pins_ = 0;
    findings_ = core::Json::array();
    return show(Screen::technician, now);
  }
  ++wrong_pins_;
  wrong_at_ = now;
  if (technician_locked(now)) return show_fault(FaultKind::locked, "", now);
  show(Screen::technician_pin, now);
  notice_ = "The PIN is wrong.";
}

core::Result<void> Machine::take_technician(const Command& command, core::Instant_ns now) {
  if (command.kind == Kind::technician && screen_ == Screen::badge && !technician_pin_.empty()) {
    if (technician_locked(now))
      show_fault(FaultKind::locked, "", now);
    else
      show(Screen::technician_pin, now);
  } else if (command.kind == Kind::pin && screen_ == Screen::technician_pin) {
    if (!is_pin(command.text)) return core::bad_input("pin: 1 to 12 digits are expected");
    judge_technician(command.text, now);
  } else if (command.kind == Kind::self_test && screen_ == Screen::technician) {
    instruct("", false);
    stops_test_ = false;
    show(Screen::testing, now);
  } else if (command.kind == Kind::confirm && screen_ == Screen::testing && waits_) {
    instruct(instruction_, false);
  } else if (command.kind == Kind::stop_test && screen_ == Screen::testing) {
    stops_test_ = true;
  } else if (command.kind == Kind::back && screen_ != Screen::testing && screen_ != Screen::badge) {
    show(Screen::badge, now);
  } else {
    return not_now(command);
  }
  return {};
}

/// A pause within a trial ends with the trial or by going on; another one by signing out as well.
core::Result<void> Machine::take_pause(const Command& command, core::Instant_ns now) {
  if (command.kind == Kind::resume) {
    show(before_pause_, now);
  } else if (command.kind == Kind::end_trial && pauses_trial()) {
    end_paused_trial(now);
  } else if (command.kind == Kind::sign_out && !pauses_trial()) {
    return leave(now);
  } else {
    return not_now(command);
  }
  return {};
}

void Machine::end_paused_trial(core::Instant_ns now) {
  ends_trial_ = true;
  show(Screen::running, now);
}

core::Result<void> Machine::take(const Command& command, core::Instant_ns now) {
  const auto at = [&](Screen screen, Kind kind) {
    return screen_ == screen && command.kind == kind && !leaves_;
  };
  if (command.kind == Kind::badge) return take_badge(command, now);
  if (leaves_) return not_now(command);
  if (screen_ == Screen::fault) return take_fault(command, now);
  if (screen_ == Screen::paused) return take_pause(command, now);
  if (command.kind == Kind::technician || screen_ >= Screen::technician_pin)
    return take_technician(command, now);
  if (at(Screen::pin, Kind::back)) {
    forget();
    show(Screen::badge, now);
  } else if (at(Screen::pin, Kind::pin)) {
    if (!is_pin(command.text)) return core::bad_input("pin: 1 to 12 digits are expected");
    credentials_ = Credentials{badge_, command.text};
    show(Screen::checking, now);
  } else if (at(Screen::work, Kind::start)) {
    show(Screen::preparing, now);
  } else if (at(Screen::running, Kind::end_trial)) {
    ends_trial_ = true;
  } else if (at(Screen::answer, Kind::answer)) {
    answer_ = command.answer;
    show(Screen::saving, now);
  } else if (at(Screen::result, Kind::next)) {
    show(Screen::preparing, now);
  } else if (at(Screen::work, Kind::pause) || at(Screen::result, Kind::pause) ||
             at(Screen::running, Kind::pause)) {
    before_pause_ = screen_;
    show(Screen::paused, now);
  } else if (at(Screen::work, Kind::sign_out) || at(Screen::result, Kind::sign_out) ||
             at(Screen::complete, Kind::sign_out)) {
    return leave(now);
  } else {
    return not_now(command);
  }
  return {};
}

double Machine::patience_s() const noexcept {
  switch (screen_) {
    case Screen::pin:
    case Screen::technician_pin:
      return times_.pin_s;
    case Screen::work:
    case Screen::result:
    case Screen::complete:
    case Screen::technician:
      return times_.idle_s;
    case Screen::answer:
      return times_.answer_s;
    case Screen::paused:
      return times_.paused_s;
    case Screen::fault:
      if (nobody_signed_in()) return fault_ == FaultKind::interrupted ? 0.0 : times_.notice_s;
      return times_.idle_s;
    default:
      return 0.0;
  }
}

bool Machine::tick(core::Instant_ns now) {
  const double patience = patience_s();
  if (leaves_ || patience == 0.0 || static_cast<double>(now - touched_) * 1e-9 < patience)
    return false;
  if (screen_ == Screen::pin || screen_ >= Screen::technician_pin ||
      (screen_ == Screen::fault && nobody_signed_in())) {
    forget();
    show(Screen::badge, now);
  } else if (screen_ == Screen::answer) {
    timed_out_ = true;
    show(Screen::saving, now);  // the trial is kept without an answer
  } else if (pauses_trial()) {
    end_paused_trial(now);
  } else {
    timed_out_ = leaves_ = true;
  }
  return true;
}

void Machine::interrupted(const std::string& what, core::Instant_ns now) {
  show_fault(FaultKind::interrupted, what, now);
}

void Machine::signed_in(const std::string& name, const std::string& language) {
  name_ = name;
  language_ = language;
  badge_.clear();
  notice_.clear();
  screen_ = Screen::preparing;
}

void Machine::sign_in_refused(const std::string& why, core::Instant_ns now) {
  show(study_ ? Screen::badge : Screen::pin, now);
  notice_ = why;
}

void Machine::sign_in_failed(FaultKind kind, const std::string& what, core::Instant_ns now) {
  forget();
  show_fault(kind, what, now);
}

void Machine::offered(const wire::AssignedWork& work, core::Instant_ns now) {
  work_ = work;
  answer_.reset();
  ends_trial_ = false;
  show(Screen::work, now);
}

void Machine::preparing() { screen_ = Screen::preparing; }

void Machine::running(const Live& live) {
  live_ = live;
  if (!pauses_trial()) screen_ = Screen::running;
}

void Machine::log(std::string line) {
  log_.insert(log_.begin(), std::move(line));
  if (log_.size() > kMostLines) log_.pop_back();
}

void Machine::instruct(const std::string& what, bool waits) {
  instruction_ = what;
  waits_ = waits;
}

void Machine::asked(const Asked& question, core::Instant_ns now) {
  asked_ = question;
  show(Screen::answer, now);
}

void Machine::saving() { screen_ = Screen::saving; }

void Machine::done(const Outcome& outcome, core::Instant_ns now) {
  outcome_ = outcome;
  show(Screen::result, now);
  if (timed_out_) leaves_ = true;
}

void Machine::failed(FaultKind kind, const std::string& what, core::Instant_ns now) {
  show_fault(kind, what, now);
  if (timed_out_) leaves_ = true;
}

void Machine::complete(core::Instant_ns now) { show(Screen::complete, now); }

void Machine::tested(core::Json findings, const std::string& why, core::Instant_ns now) {
  show(Screen::technician, now);
  findings_ = std::move(findings);
  notice_ = why;
}

void Machine::signed_out(core::Instant_ns now) {
  const bool timed_out = timed_out_;
  forget();
  if (timed_out)
    show_fault(FaultKind::timed_out, "", now);
  else
    show(Screen::badge, now);
}

std::optional<Credentials> Machine::take_credentials() {
  return std::exchange(credentials_, std::nullopt);
}

}  // namespace kiosk
}  // namespace tractus
