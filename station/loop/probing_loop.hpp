/// The probing rig's loop: exchange → guard → law → guard, and a sample to the recorder.
#pragma once

#include <atomic>
#include <functional>

#include "models/probing_runtime.hpp"
#include "station/devices/rig_device.hpp"
#include "station/loop/live_state.hpp"
#include "station/loop/pause.hpp"
#include "station/loop/periodic_loop.hpp"
#include "station/loop/probing_guard.hpp"
#include "station/loop/ring.hpp"
#include "trial/trial.hpp"

namespace tractus::loop {

using ProbingRing = Ring<trial::ProbingSample>;

/// The latest of a running trial.
struct ProbingLoopSnapshot {
  double t_s = 0.0, x_m = 0.0, speed_m_s = 0.0, fz_N = 0.0, turning_rad_s = 0.0;
  std::uint64_t missed = 0;
  std::uint32_t tick = 0;
  trial::ProbingMode mode = trial::ProbingMode::holding;
};

/// One exchange a period, absolute deadlines. In each tick goes out what the last one decided, and
/// what comes back is judged, the law is stepped at the depth where the stage is, and the guard
/// lets through what may be. Owns nothing but its counts. In the tick: no throw, no allocation,
/// no lock; the exchange may block for RigDevice::kAnswer_ms.
class ProbingLoop {
 public:
  struct Parts {
    core::Clock& clock;  ///< paces the ticks: the monotonic one, or a manual one
    core::Clock& wall;   ///< times the exchange
    devices::RigDevice& device;
    ProbingGuard& guard;
    ProbingRing& ring;
    Seqlock<ProbingLoopSnapshot>& live;
  };
  /// @param law       may be exchanged while running
  /// @param travel_m  the probe stop
  ProbingLoop(Parts parts, const models::ProbingRuntime& law, double travel_m, double rate_Hz);

  /// Until `stop()`, or the guard latches, or the probe has stood at its stop for kStopped_s.
  /// `each_tick` (may be empty) runs after each tick under the tick's rules. While the guard is
  /// paused the rig is read, but nothing is recorded. The drive is left off.
  void run(const std::function<void(const trial::ProbingSample&)>& each_tick = {}) noexcept;
  /// From any thread.
  void stop() noexcept { periods_.stop(); }
  /// From any thread: another law from the next tick on; it and the one before must outlive the
  /// run.
  void exchange_law(const models::ProbingRuntime& law) noexcept {
    law_.store(&law, std::memory_order_release);
  }

  static constexpr double kStopped_s = 0.5;

  /// The highest that the stage ever gave the pushing hand beyond what it took, J: −∫ F dx.
  double injected_J() const noexcept { return injected_J_; }
  const PeriodicLoop& periods() const noexcept { return periods_; }
  const trial::TickCounts& counts() const noexcept { return periods_.counts(); }
  const TimeHistogram& round_trip() const noexcept { return round_trip_; }

 private:
  trial::ProbingSample tick(core::Instant_ns now, std::uint32_t number, bool late) noexcept;
  void step_law(const ProbingGuard::LawInput& seen, trial::ProbingSample& out,
                double& torque_Nm) noexcept;
  void follow_energy(double push_N) noexcept;
  void follow_angle(std::int32_t angle_urad) noexcept;
  void record(trial::ProbingSample& sample, core::Instant_ns deadline) noexcept;

  Parts parts_;
  std::atomic<const models::ProbingRuntime*> law_;
  double travel_m_, period_s_;
  PeriodicLoop periods_;
  TrialTimeline timeline_;
  bool paused_ = false;
  models::ProbingLive at_;
  devices::RigReading reading_;
  devices::RigCommand command_;
  std::int32_t last_urad_ = 0;
  double theta_rad_ = 0.0, stopped_s_ = 0.0;
  double last_push_N_ = 0.0, last_x_m_ = 0.0, given_J_ = 0.0, injected_J_ = 0.0;
  bool angle_known_ = false;
  TimeHistogram round_trip_;
};

}  // namespace tractus::loop
