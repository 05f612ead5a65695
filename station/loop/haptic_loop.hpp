/// The haptic loop: device → model → limiter → device, and a sample to the recorder.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "station/devices/device.hpp"
#include "station/loop/contact.hpp"
#include "station/loop/limiter.hpp"
#include "station/loop/live_state.hpp"
#include "station/loop/ring.hpp"
#include "station/loop/tool.hpp"
#include "station/safety/energy.hpp"
#include "trial/trial.hpp"

namespace tractus::loop {

using SampleRing = Ring<trial::Sample>;

/// What a loop counted. Read after `run`, or by the loop's own thread.
struct Counts {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;     ///< woke more than a quarter period after the deadline
  std::uint64_t skipped = 0;  ///< deadlines that passed whole: never chased
  std::uint64_t not_converged = 0;
  std::uint64_t limited = 0;
  std::uint64_t stale = 0;
  std::uint64_t lost = 0;  ///< samples that the full ring refused: a fault of the recording
};

/// How long the tick's parts took, in bins of 1 µs up to 1 ms and one for all above. Real-time safe
/// to fill.
class TimeHistogram {
 public:
  void add(core::Instant_ns duration) noexcept {
    const auto bin = duration < 0 ? 0 : duration / 1000;
    ++bins_[std::size_t(bin < kBins - 1 ? bin : kBins - 1)];
    ++count_;
  }
  /// Upper edge of the bin that holds the share-quantile, µs.
  double quantile_us(double share) const noexcept;

 private:
  static constexpr core::Instant_ns kBins = 1001;
  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

/// What is done about energy that the device puts into the hand (safety/energy.hpp).
enum class Passivity {
  observed,    ///< logged alone
  controlled,  ///< and taken back by damping
};

/// Owns nothing but its counters. Knows no file, no network, no lock.
class HapticLoop {
 public:
  struct Parts {
    core::Clock& clock;
    devices::Device& device;
    Contact& contact;
    Limiter& limiter;
    SampleRing& ring;
    LiveState& live;
    Passivity passivity = Passivity::observed;
    Tool* tool = nullptr;  ///< one that changes the bone; none: a probe
  };
  /// @param X_VD           the device's frame in the volume's
  /// @param pose_offset_m  of the model: only for what `live` shows
  /// @param rate_Hz        100 … 20000
  HapticLoop(Parts parts, const math::Pose& X_VD, const math::Vec3& pose_offset_m, double rate_Hz);

  /// Runs until `stop()` or the limiter latches; absolute deadlines from now on. `each_tick` (may
  /// be empty) runs after each tick; in real time it is under the tick's rules. The device is left
  /// at zero force.
  void run(const std::function<void()>& each_tick = {}) noexcept;
  /// One tick of the given stamp and number: what `run` calls. Real-time safe.
  void tick(core::Instant_ns now, std::uint32_t number, bool late) noexcept;
  /// From any thread.
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

  const Counts& counts() const noexcept { return counts_; }
  const safety::EnergyObserver& energy() const noexcept { return energy_; }
  const TimeHistogram& wake() const noexcept { return wake_; }  ///< wake-up after the deadline
  const TimeHistogram& work() const noexcept { return work_; }  ///< the whole tick
  core::Instant_ns started() const noexcept { return start_; }
  core::Instant_ns period() const noexcept { return period_; }

 private:
  void record(const trial::Sample& sample) noexcept;
  math::Wrench wanted_of(const laws::PalpationStep& step, const devices::Sample& sample,
                         bool usable) noexcept;
  Parts parts_;
  math::Pose X_VD_;
  math::Pose X_DH_;  ///< the last good one
  math::Vec3 pose_offset_m_;
  core::Instant_ns period_;
  core::Instant_ns start_ = 0;
  Counts counts_;
  safety::EnergyObserver energy_;
  TimeHistogram wake_, work_;
  std::atomic<bool> stop_ = false;
};

}  // namespace tractus::loop
