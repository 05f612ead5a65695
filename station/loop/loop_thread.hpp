/// The thread that a loop runs in.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <thread>

#include "station/loop/realtime.hpp"

namespace tractus::loop {

/// How time passes for a loop.
enum class Pace {
  real_time,        ///< its thread asks the system for real time
  as_fast_as_goes,  ///< under a manual clock: an ordinary thread
};

/// A thread for one run of a loop. It is set up first (realtime.hpp) and then waits for `go`, so
/// that what the system granted can be recorded before the first tick.
class LoopThread {
 public:
  /// Returns when the thread is set up. `run` is called in it after `go`.
  LoopThread(Pace pace, std::function<void()> run);
  ~LoopThread();  ///< without `go`, `run` is not called; after it, `join` must have been
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  const RealtimeGrant& grant() const noexcept { return grant_; }
  /// Once.
  void go();
  /// Waits for the end of `run`, for so long at most.
  bool ended_within(std::chrono::milliseconds wait) const;
  void join();

 private:
  void work(Pace pace, const std::function<void()>& run);
  RealtimeGrant grant_;
  std::promise<void> ready_, done_;
  std::promise<bool> go_;  ///< false: nothing is to run
  std::future<void> ended_ = done_.get_future();
  bool gone_ = false;
  std::thread thread_;
};

}  // namespace tractus::loop
