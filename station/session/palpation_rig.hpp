/// A haptic handle in a case: a tract is felt with a probe, or drilled with a burr.
#pragma once

#include <memory>
#include <optional>

#include "drilling/burr.hpp"
#include "station/loop/haptic_loop.hpp"
#include "station/session/prepared_case.hpp"
#include "station/session/trial_runner.hpp"

namespace tractus::session {

struct TrialSetup {
  std::string device = "sim-lambda6";  ///< of the catalogue, a handle
  std::filesystem::path sdk = {};      ///< of a device that needs its vendor's library
  std::uint64_t seed = 1;
  double duration_s = 30.0;
  Speed speed = Speed::real;
  double rate_Hz = 4000.0;
  loop::Passivity passivity = loop::Passivity::observed;
  std::optional<drilling::Burr> burr = {};  ///< the tool; none: a probe
  /// Of an assigned trial: what its file calls the case and the trainee instead.
  std::string case_known_as = {};
  std::string operator_name = {};
  RemoteSupervisor* outside = nullptr;  ///< who may stop it from afar; outlives the trial
  std::optional<std::int64_t> started_utc_us = {};  ///< fast alone: a SIMULATED date; else now
};

class PalpationRig final : public Rig {
 public:
  /// `prepared` and `config` must outlive this. Errors: not_found (no such device).
  static core::Result<std::unique_ptr<PalpationRig>> make(const StationConfig& config,
                                                          const PreparedCase& prepared,
                                                          const TrialSetup& setup);
  ~PalpationRig() override;
  /// Readable from any thread at any time, without a lock.
  const loop::LiveState& live() const noexcept { return live_; }

  const devices::DeviceInfo& device() const override { return info_; }
  TrialTerms terms() const override;
  std::size_t sample_bytes() const override { return sizeof(trial::Sample); }
  core::Result<void> prepare(TrialTime& time) override;
  void describe(trial::Header& header) const override;
  void record(trial::TrialWriter writer) override;
  loop::TrialRecorder& recorder() override { return *recorder_; }
  void arm() override;
  void run() noexcept override;
  void stop() noexcept override { loop_->stop(); }
  void cap_force(double force_N) noexcept override { limiter_.cap_force(force_N); }
  void pause(bool on) noexcept override;
  TrialSnapshot latest(const trial::Header& header) const override;
  const loop::PeriodicLoop& periods() const override { return loop_->periods(); }
  Ended settle() override;
  std::optional<trial::Answer> simulated_answer() const override;
  void complete(TrialReport& report) override;
  std::vector<trial::Event> closing_events(const TrialReport& report, double t_s) const override;
  core::Json end_detail(const TrialReport& report) const override;
  core::Result<void> keep(const StationFolder& folder, const trial::Header& header) const override;

 private:
  PalpationRig(const StationConfig& config, const PreparedCase& prepared, const TrialSetup& setup,
               const devices::DeviceInfo& info);
  core::Result<void> take_tool();
  core::Result<void> open_device();
  core::Json extra_of_header() const;
  void after_tick();

  const PreparedCase& prepared_;
  TrialSetup setup_;
  devices::DeviceInfo info_;
  math::Pose X_VD_;
  TrialTime* time_ = nullptr;
  devices::MadeDevice made_;
  devices::Limits opened_;
  loop::SampleRing ring_;
  loop::LiveState live_;
  std::unique_ptr<loop::Drilling> drilling_;  ///< null with a probe
  std::optional<loop::PalpationContact> contact_;
  loop::Limiter limiter_;
  TipWay way_;
  std::optional<loop::Recorder> recorder_;
  std::optional<loop::HapticLoop> loop_;
};

using PalpationTrial = TrialOn<PalpationRig>;

/// `folder` and `prepared` must outlive the trial. Errors: those of PalpationRig and TrialRunner.
core::Result<PalpationTrial> palpation_trial(const StationFolder& folder,
                                             const PreparedCase& prepared, const TrialSetup& setup);

}  // namespace tractus::session
