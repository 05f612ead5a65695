/// What the terminal (`assigned`) and the kiosk share: a trainee's assigned trials, one after the
/// other.
#pragma once

#include <functional>

#include "station/app/options.hpp"
#include "station/app/presence.hpp"
#include "station/uplink/assigned.hpp"

namespace tractus::app {

/// What was under way when an Error came.
enum class Stage { server, trial };

/// What is asked once a trial has ended.
struct Question {
  trial::Rig rig = trial::Rig::palpation;
  double length_m = 0.0;  ///< of the tract; of the rig, how far the probe can go
};

/// The person at the station, as the rounds meet them. Called from the thread that runs the rounds;
/// `look` some thirty times a second, and it must not wait.
class Trainee {
 public:
  virtual ~Trainee() = default;
  /// Before each trial: false when somebody stopped the station, or it is to end.
  virtual bool may_begin() = 0;
  /// The next trial is shown; false: the trainee does not want it now.
  virtual bool starts(const wire::AssignedWork& work) = 0;
  /// False ends the trial in good order.
  virtual bool look(const session::TrialSnapshot& seen) = 0;
  /// @param simulated  what a simulated hand says
  /// Errors: bad_input.
  virtual core::Result<std::optional<trial::Answer>> answer(
      const Question& question, const std::optional<trial::Answer>& simulated) = 0;
  /// After an Error: whether the same is tried once more.
  virtual bool tries_again(Stage stage, const core::Error& error) = 0;
  /// After a trial, which is kept. After one that ended in a fault a person looks at the device
  /// first. @param sent  the server has it
  virtual bool goes_on(const wire::AssignedWork& work, const session::TrialReport& report,
                       bool sent) = 0;
};

/// What was done and what is left.
struct AssignedTally {
  core::Json trials = core::Json::array();
  std::uint64_t left = 0;
  bool faulted = false;
  std::string unstarted = {};  ///< slot of a trial that was given and not begun; empty: none
};

/// Where the next trial comes from. @param all_sent  the server has every trial that was done
using NextWork = std::function<core::Result<wire::AssignedWork>(bool all_sent)>;
/// Of the trainee's assignments: the server has each trial before it gives the next.
NextWork assigned_work(const Options& options, const session::StationFolder& folder,
                       uplink::Server& server, const uplink::Ticket& ticket);

/// Errors: those of `next`, the device's, the disk's, those of the trainee's answer; `tally` then
/// holds what was done before.
core::Result<void> do_assigned(const Options& options, Presence& presence,
                               const session::StationFolder& folder, const NextWork& next,
                               Trainee& trainee, AssignedTally& tally);

}  // namespace tractus::app
