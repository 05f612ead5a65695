/// A pause within a trial: who may ask for one, and the trial's time without it.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/clock.hpp"

namespace tractus::loop {

/// Whether a pause is asked for. From any thread, without a lock.
class PauseSwitch {
 public:
  PauseSwitch() = default;
  PauseSwitch(const PauseSwitch& other) noexcept : on_(other.on()) {}
  PauseSwitch& operator=(const PauseSwitch& other) noexcept {
    set(other.on());
    return *this;
  }
  void set(bool on) noexcept { on_.store(on, std::memory_order_relaxed); }
  bool on() const noexcept { return on_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> on_ = false;
};

/// Time and tick numbers of a trial's samples. Ticks of a pause are not recorded, and the first
/// sample after it follows the last one before it by one period. Real-time safe.
class TrialTimeline {
 public:
  /// Each tick, in order. @param paused  this tick is not recorded
  void tick(core::Instant_ns now, std::uint32_t number, bool paused) noexcept {
    if (paused && ticked_) paused_ns_ += now - last_, paused_ticks_ += number - last_number_;
    last_ = now;
    last_number_ = number;
    ticked_ = true;
  }
  /// Of the last tick. @param start  stamp of the first tick's deadline
  double t_s(core::Instant_ns start) const noexcept {
    return static_cast<double>(last_ - start - paused_ns_) * 1e-9;
  }
  std::uint32_t number() const noexcept { return last_number_ - paused_ticks_; }

 private:
  core::Instant_ns last_ = 0, paused_ns_ = 0;
  std::uint32_t last_number_ = 0, paused_ticks_ = 0;
  bool ticked_ = false;
};

}  // namespace tractus::loop
