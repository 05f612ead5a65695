/// A headset in a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "station/headset/headset.hpp"

namespace tractus::headset {

/// The trial goes on whatever happens here; who wants to know asks `seen`.
class HeadsetThread {
 public:
  /// Returns once the session is open and the scene is on the GPU. Errors: those of Headset::make.
  static core::Result<std::unique_ptr<HeadsetThread>> start(Shown shown);
  ~HeadsetThread();

  DisplayState seen() const { return seen_.load(); }
  /// Until somebody sees the scene, or it is over, or so long. Was it seen?
  bool wait_until_seen(std::chrono::milliseconds longest) const;
  /// Ends the session in good order (at most two seconds) and joins. Again: the same figures.
  const Figures& end();

 private:
  HeadsetThread() = default;
  void work(const Shown& shown, class Opened& opened);
  std::atomic<DisplayState> seen_ = DisplayState::waiting;
  std::atomic<bool> to_end_ = false;
  Figures figures_;  ///< written by the thread, read after it was joined
  std::thread thread_;
};

}  // namespace tractus::headset
