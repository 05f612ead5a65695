#include "station/session/station.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus::session {

core::Error Station::not_now(const char* action) const {
  return {core::Errc::conflict,
          fmt::format("the station is {}: it cannot {} now", name(state_), action)};
}

core::Result<void> Station::prepare(std::shared_ptr<const PreparedCase> prepared,
                                    std::uint64_t seed) {
  if (state_ != State::idle && state_ != State::done && state_ != State::fault)
    return not_now("prepare a trial");
  trial_.reset();
  state_ = State::idle;
  prepared_ = std::move(prepared);
  setup_.seed = seed;
  auto made = TRY(palpation_trial(folder_, *prepared_, setup_));
  trial_.emplace(std::move(made));
  state_ = State::ready;
  return {};
}

core::Result<void> Station::run(const Watch& watch) {
  if (state_ != State::ready) return not_now("start");
  state_ = State::running;
  auto ran = trial_->runner->run(watch);
  state_ = !ran || !trial_->runner->fault().empty() ? State::fault : State::answering;
  return ran;
}

std::optional<trial::Answer> Station::simulated_answer() const {
  return state_ == State::answering ? trial_->runner->simulated_answer() : std::nullopt;
}

core::Result<void> Station::note(trial::EventKind kind, const core::Json& detail) {
  const bool ended = state_ == State::answering || (state_ == State::fault && trial_);
  return ended ? trial_->runner->note(kind, detail) : core::Result<void>(not_now("note an event"));
}

core::Result<TrialReport> Station::answer(const std::optional<trial::Answer>& answer) {
  const bool faulted = state_ == State::fault && trial_;
  if (state_ != State::answering && !faulted) return not_now("take an answer");
  auto report = trial_->runner->finish(faulted ? std::nullopt : answer);
  trial_.reset();
  state_ = report && !faulted ? State::done : State::fault;
  return report;
}

}  // namespace tractus::session
