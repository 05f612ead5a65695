/// The states of a training session.
#pragma once

#include <memory>
#include <optional>

#include "core/named.hpp"
#include "station/session/palpation_rig.hpp"

namespace tractus::session {

enum class State { idle, ready, running, answering, done, fault };
constexpr auto words(State) {
  using enum State;
  return std::to_array<core::Word<State>>({{idle, "idle"},
                                           {ready, "ready"},
                                           {running, "running"},
                                           {answering, "answering"},
                                           {done, "done"},
                                           {fault, "fault"}});
}
using core::name;

/// One station, one trial at a time. Every deed says in which states it is allowed; elsewhere it is
/// Errc::conflict and nothing happens. Not for several threads.
class Station {
 public:
  Station(const StationFolder& folder, TrialSetup setup)
      : folder_(folder), setup_(std::move(setup)) {}

  State state() const noexcept { return state_; }
  /// idle, done, fault → ready. `prepared` is kept for this trial. From `fault` this is the
  /// operator's deed that arms anew.
  core::Result<void> prepare(std::shared_ptr<const PreparedCase> prepared, std::uint64_t seed);
  /// ready → running → answering, or fault.
  core::Result<void> run(const Watch& watch = {});
  /// answering, fault: an event for the trial's file.
  core::Result<void> note(trial::EventKind kind, const core::Json& detail);
  /// answering → done; fault → fault (a fault takes no answer, but the trial is sealed and kept).
  core::Result<TrialReport> answer(const std::optional<trial::Answer>& answer);
  /// What the simulated hand says, in `answering`.
  std::optional<trial::Answer> simulated_answer() const;
  /// Of the trial that is prepared or running, readable from any thread without a lock; null
  /// elsewhere.
  const loop::LiveState* live() const { return trial_ ? &trial_->rig->live() : nullptr; }

 private:
  core::Error not_now(const char* action) const;
  const StationFolder& folder_;
  TrialSetup setup_;
  State state_ = State::idle;
  std::shared_ptr<const PreparedCase> prepared_;
  std::optional<PalpationTrial> trial_;
};

}  // namespace tractus::session
