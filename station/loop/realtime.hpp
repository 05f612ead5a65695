/// Asking the system for real time.
#pragma once

#include <string>
#include <vector>

#include "core/json.hpp"

namespace tractus::loop {

/// What the system granted to the calling thread. A refusal is no error: the loop runs on, and the
/// trial says so.
struct RealtimeGrant {
  bool fifo = false;                  ///< SCHED_FIFO
  bool locked = false;                ///< all memory, now and later
  bool awake = false;                 ///< no processor sleeps deeply between two ticks
  std::vector<std::string> warnings;  ///< one line each, for a person

  core::Json to_json() const;
};

/// Made by the loop's thread before its first tick, and kept as long as it runs: FIFO priority 80,
/// mlockall, the stack touched, and processors that wake at once (PM QoS, /dev/cpu_dma_latency held
/// at 0 µs: else an idle one takes tens of microseconds, which at 4 kHz is a late tick).
class Realtime {
 public:
  Realtime();
  ~Realtime();  ///< processors may sleep again
  Realtime(const Realtime&) = delete;
  Realtime& operator=(const Realtime&) = delete;
  const RealtimeGrant& grant() const { return grant_; }

 private:
  RealtimeGrant grant_;
  int awake_fd_ = -1;
};

}  // namespace tractus::loop
