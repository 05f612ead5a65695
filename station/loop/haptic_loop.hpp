/// The haptic loop: device → model → limiter → device, and a sample to the recorder.
#pragma once

#include <cstdint>
#include <functional>

#include "station/devices/device.hpp"
#include "station/loop/contact.hpp"
#include "station/loop/limiter.hpp"
#include "station/loop/live_state.hpp"
#include "station/loop/pause.hpp"
#include "station/loop/periodic_loop.hpp"
#include "station/loop/ring.hpp"
#include "station/loop/tool.hpp"
#include "station/safety/energy.hpp"
#include "trial/trial.hpp"

namespace tractus::loop {

using SampleRing = Ring<trial::Sample>;

/// What is done about energy that the device puts into the hand (safety/energy.hpp).
enum class Passivity {
  observed,    ///< logged alone
  controlled,  ///< and taken back by damping
};

/// Owns nothing but its counts. Knows no file, no network, no lock.
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
  /// be empty) runs after each tick; in real time it is under the tick's rules. While the limiter
  /// is paused the device is read and gets zero force, but nothing is recorded and no bone is worn.
  /// The device is left at zero force.
  void run(const std::function<void()>& each_tick = {}) noexcept;
  /// One tick of the given stamp and number: what `run` calls. Real-time safe.
  void tick(core::Instant_ns now, std::uint32_t number, bool late) noexcept;
  /// From any thread.
  void stop() noexcept { periods_.stop(); }

  const PeriodicLoop& periods() const noexcept { return periods_; }
  const trial::TickCounts& counts() const noexcept { return periods_.counts(); }
  const safety::EnergyObserver& energy() const noexcept { return energy_; }

 private:
  math::Wrench wanted_of(const laws::PalpationStep& step, const devices::Sample& sample,
                         bool usable) noexcept;
  Parts parts_;
  math::Pose X_VD_;
  math::Pose X_DH_;  ///< the last good one
  math::Vec3 pose_offset_m_;
  PeriodicLoop periods_;
  TrialTimeline timeline_;
  safety::EnergyObserver energy_;
};

}  // namespace tractus::loop
