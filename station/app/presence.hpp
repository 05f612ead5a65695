/// The station as those who look on see it, and what they may ask of it: the live line, wired to
/// whatever this program does.
#pragma once

#include <memory>

#include "station/app/options.hpp"
#include "station/session/station_folder.hpp"
#include "wire/live.hpp"

namespace tractus::app {

class Presence {
 public:
  using State = wire::StationState;

  /// Opens the line when a server was named; without, everything here does nothing.
  Presence(const Options& options, const session::StationFolder& folder);
  ~Presence();
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  /// For TrialSetup and RigSetup.
  session::RemoteSupervisor* outside() noexcept;
  void is(State state) noexcept;
  /// Shows the trial to those who look on, and goes on with `inner`.
  session::Watch watched(session::Watch inner);
  /// After a trial: idle again, or fault, or stopped.
  void done(const session::TrialReport& report);
  /// Nobody stopped it, or a person at the terminal says that it goes on. False: it was stopped,
  /// and nobody is there.
  bool may_resume();
  /// A person at the station says that it goes on after a stop.
  void resume();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::app
