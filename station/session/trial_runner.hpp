/// One attempt, on either rig: file, thread, onlooker, stop from afar, pauses, end.
#pragma once

#include <memory>

#include "core/try.hpp"
#include "station/session/rig.hpp"

namespace tractus::session {

/// make → run → finish. Whatever happens in `run`, `finish` seals the file and queues it for the
/// upload, marked with the fault if there was one. Without `finish` the next start recovers the
/// file.
class TrialRunner {
 public:
  /// Checks terms and disk, prepares the rig, makes the trial file. `folder` must outlive this.
  /// Errors: bad_input, out_of_range, io, those of the rig.
  static core::Result<std::unique_ptr<TrialRunner>> make(const StationFolder& folder,
                                                         std::unique_ptr<Rig> rig);

  /// The loop in a thread of its own until it ends or `watch` says so. Errors: io of the recorder.
  /// A fault of the rig is no Error: `fault`.
  core::Result<void> run(const Watch& watch = {});
  /// One line; empty when there was none.
  const std::string& fault() const noexcept { return fault_; }
  /// What the simulated hand answers; nothing for a device that a person holds.
  std::optional<trial::Answer> simulated_answer() const { return rig_->simulated_answer(); }
  /// After `run`: an event of the trial's file that no other call writes.
  core::Result<void> note(trial::EventKind kind, const core::Json& detail);
  /// Writes the answer (if any, and no fault) and the end, seals the file and queues it for upload.
  core::Result<TrialReport> finish(const std::optional<trial::Answer>& answer);

 private:
  TrialRunner(const StationFolder& folder, std::unique_ptr<Rig> rig);
  core::Result<void> make_file();
  void watch_until_end(const loop::LoopThread& thread, const Watch& watch);
  void apply_remote_commands();
  void follow_pause(bool on);
  void settle();
  double elapsed_s();
  TrialReport report_of(const std::optional<trial::Answer>& answer);
  core::Result<void> append_end(const TrialReport& report);

  const StationFolder& folder_;
  TrialTerms terms_;
  TrialTime time_;
  trial::Header header_;
  std::unique_ptr<Rig> rig_;  ///< after what it uses
  loop::RealtimeGrant grant_;
  std::string fault_;
  std::optional<core::Instant_ns> paused_since_;
  core::Instant_ns paused_ns_ = 0;  ///< of the pauses that are over
  std::vector<trial::Event> pauses_;
};

/// A trial, and the rig that its runner owns.
template <class SomeRig>
struct TrialOn {
  std::unique_ptr<TrialRunner> runner;
  SomeRig* rig = nullptr;

  static core::Result<TrialOn> make(const StationFolder& folder, std::unique_ptr<SomeRig> rig) {
    SomeRig* own = rig.get();
    auto runner = TRY(TrialRunner::make(folder, std::move(rig)));
    return TrialOn{std::move(runner), own};
  }
};

}  // namespace tractus::session
