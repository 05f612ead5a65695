/// What may reach a running trial from afar: a stop, and a lower limit. Never more force.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "station/loop/falling.hpp"

namespace session {

/// Safe from several threads. The haptic loop never waits for it: the thread that watches the trial
/// hands on what it says.
class Outside {
 public:
  /// The running trial ends with zero force, and none begins until a person at the station says so.
  /// The first reason stays.
  void stop(const std::string& reason) {
    const std::lock_guard held(mutex_);
    if (stopped_.load()) return;
    reason_ = reason;
    stopped_.store(true);
  }
  bool stopped() const noexcept { return stopped_.load(); }
  std::string reason() const {
    const std::lock_guard held(mutex_);
    return reason_;
  }
  /// The deed of a person at the station.
  void go_on() {
    const std::lock_guard held(mutex_);
    stopped_.store(false);
    reason_.clear();
  }

  /// At most so much on the hand from now on; it only falls.
  void lower_force(double force_N) noexcept { force_N_.lower(force_N); }
  /// Infinite: nobody lowered it.
  double force_N() const noexcept { return force_N_.value(); }

 private:
  mutable std::mutex mutex_;  ///< guards reason_
  std::string reason_;
  std::atomic<bool> stopped_ = false;
  loop::Falling force_N_;
};

/// The fault of a trial that was stopped, as its file and the screen say it.
inline std::string stopped_text(const Outside& outside) {
  return "stopped by a supervisor: " + outside.reason();
}

}  // namespace session
