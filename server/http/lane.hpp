/// Separate threads for requests that keep a thread busy or waiting for a long time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

namespace tractus::http {

/// On which threads a request is handled.
enum class Lane {
  quick,      ///< the worker threads; the request waits for nothing slower than the disk
  hashing,    ///< the request computes a password hash: 64 MiB and about 0.1 s of a core
  remote,     ///< the request waits for another server
  computing,  ///< the request computes for seconds; whoever asks may call it off
};

/// Who sends the request; requests of strangers may fill only a part of a lane's queue.
enum class Standing { stranger, familiar };

/// At most `threads` requests of a lane are handled at the same time, and at most `waiting` more
/// wait. A further request is answered with 503 and Retry-After.
struct LaneLimits {
  std::size_t threads;
  std::size_t waiting_strangers;
  std::size_t waiting;  ///< strangers and others
};

/// Half of the cores, which leaves the other half to all other work; at most 8 threads (512 MiB).
inline LaneLimits hashing_limits() {
  const std::size_t cores = std::thread::hardware_concurrency();
  return {
      .threads = std::clamp<std::size_t>(cores / 2, 1, 8), .waiting_strangers = 8, .waiting = 32};
}

}  // namespace tractus::http
