/// The probing rig in a scenario, or in a model alone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "station/devices/felt_breach.hpp"
#include "station/loop/probing_loop.hpp"
#include "station/session/probing_task.hpp"
#include "station/session/trial_runner.hpp"

namespace tractus::session {

/// Where the rig is, and who is on it.
struct RigSetup {
  std::string device = "sim-rig";          ///< of the catalogue, a rig
  std::string address = "127.0.0.1:1502";  ///< of a machine: HOST:PORT, or "/dev/…[@BAUD]"
  std::filesystem::path program;           ///< of a simulated one; empty: beside this program
  std::uint64_t seed = 1;                  ///< of the simulated surgeon, the sensor and the answer
  double skill = 0.5;                      ///< of the simulated surgeon, 0 … 1
  bool surgeon = true;                     ///< a SIMULATED surgeon pushes; else nobody does
  Speed speed = Speed::real;  ///< fast: simulated alone, in this process, without the bus
  std::optional<std::int64_t> started_utc_us = {};  ///< fast alone: a SIMULATED date; else now
  double rate_Hz = 1000.0;                          ///< 100 … 1000
  double duration_s = 120.0;                        ///< at most so long
  RemoteSupervisor* outside = nullptr;  ///< who may stop it from afar; outlives the trial
};

class ProbingRig final : public Rig {
 public:
  /// Errors: not_found (no such device), out_of_range, those of the law.
  static core::Result<std::unique_ptr<ProbingRig>> make(const ProbingTask& task,
                                                        const RigSetup& setup);
  ~ProbingRig() override;
  /// Feels another law from the next tick on: an expert tunes. Same travel; effects stay. From the
  /// thread that calls the watch. Errors: those of making the law.
  /// @param what  what a reader of the trial is to know of it: the detail of a "retuned" event
  core::Result<void> retune(const laws::ProbingParameters& law, core::Json what);

  const devices::DeviceInfo& device() const override { return info_; }
  TrialTerms terms() const override;
  std::size_t sample_bytes() const override { return sizeof(trial::ProbingSample); }
  /// Also brings the stage back to the entry if it is not there.
  core::Result<void> prepare(TrialTime& time) override;
  void describe(trial::Header& header) const override;
  void record(trial::TrialWriter writer) override;
  loop::TrialRecorder& recorder() override { return *recorder_; }
  void arm() override {}  // the guard was made armed: a person began the trial
  void run() noexcept override;
  void stop() noexcept override { loop_->stop(); }
  void cap_force(double force_N) noexcept override { guard_->cap_push(force_N); }
  void pause(bool on) noexcept override { guard_->pause(on); }
  TrialSnapshot latest(const trial::Header& header) const override;
  const loop::PeriodicLoop& periods() const override { return loop_->periods(); }
  Ended settle() override;
  std::optional<trial::Answer> simulated_answer() const override;
  void complete(TrialReport& report) override;
  std::vector<trial::Event> closing_events(const TrialReport& report, double t_s) const override;
  core::Json end_detail(const TrialReport& report) const override;
  core::Result<void> keep(const StationFolder&, const trial::Header&) const override { return {}; }

 private:
  ProbingRig(const ProbingTask& task, const RigSetup& setup, const devices::DeviceInfo& info);
  core::Result<void> check() const;
  core::Result<void> open_device();
  core::Result<void> add_law(const laws::ProbingParameters& law);
  std::string operator_name() const;
  void after_tick(const trial::ProbingSample& sample);

  ProbingTask task_;
  RigSetup setup_;
  devices::DeviceInfo info_;
  TrialTime* time_ = nullptr;
  std::optional<devices::MadeRig> made_;
  devices::RigIdentity identity_;
  loop::ProbingRing ring_;
  loop::Seqlock<loop::ProbingLoopSnapshot> live_;
  loop::RigLimits limits_;
  std::optional<loop::ProbingGuard> guard_;
  std::vector<std::unique_ptr<models::ProbingRuntime>> laws_;  ///< all that were ever felt
  std::optional<devices::FeltBreach> felt_;
  std::optional<loop::ProbingRecorder> recorder_;
  std::optional<loop::ProbingLoop> loop_;
  std::vector<trial::Event> retuned_;
};

using ProbingTrial = TrialOn<ProbingRig>;

/// `folder` must outlive the trial. Errors: those of ProbingRig and TrialRunner.
core::Result<ProbingTrial> probing_trial(const StationFolder& folder, const ProbingTask& task,
                                         const RigSetup& setup);

/// Asks for the answer once a trial has ended without a fault.
/// @param simulated  what the simulated surgeon says it felt; nothing when a person was on the rig
using Ask = std::function<core::Result<std::optional<trial::Answer>>(
    const std::optional<trial::Answer>& simulated)>;

/// make, run and finish in one; the simulated surgeon's answer when `ask` is empty.
core::Result<TrialReport> run_probing_trial(const StationFolder& folder, const ProbingTask& task,
                                            const RigSetup& setup, const Watch& watch = {},
                                            const Ask& ask = {});

}  // namespace tractus::session
