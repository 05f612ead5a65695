/// What others than the loop may change in a running trial: a supervisor over the network stops it
/// or lowers the force limit, which is never raised; the trainee pauses it.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "station/loop/decreasing_limit.hpp"
#include "station/loop/pause.hpp"

namespace tractus::session {

/// Safe from several threads. The haptic loop never waits for it: the thread that watches the trial
/// hands on what it says.
class RemoteSupervisor {
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
  /// Called when a person at the station confirms that trials may continue.
  void resume() {
    const std::lock_guard held(mutex_);
    stopped_.store(false);
    reason_.clear();
  }

  /// At most so much on the hand from now on; it only falls.
  void lower_force(double force_N) noexcept { force_N_.lower(force_N); }
  /// Infinite: nobody lowered it.
  double force_N() const noexcept { return force_N_.value(); }

  /// No force on the hand, and no time of the trial passes, until the trainee goes on.
  void pause(bool on) noexcept { pause_.set(on); }
  bool paused() const noexcept { return pause_.on(); }

 private:
  mutable std::mutex mutex_;  ///< guards reason_
  std::string reason_;
  std::atomic<bool> stopped_ = false;
  loop::DecreasingLimit force_N_;
  loop::PauseSwitch pause_;
};

/// The fault of a trial that was stopped, as its file and the screen state it.
inline std::string stop_message(const RemoteSupervisor& outside) {
  return "stopped by a supervisor: " + outside.reason();
}

}  // namespace tractus::session
