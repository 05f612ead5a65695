/// Threads of their own for requests that keep a thread busy or waiting for long.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

namespace tractus::http {

/// On which threads a request is handled.
enum class Lane {
  quick,    ///< the workers: it waits for the disk at most
  hashing,  ///< it computes a password's hash: 64 MiB and about 0.1 s of a core
  remote,   ///< it waits for another server
};

/// Whose request it is: strangers may fill only a part of a lane's queue.
enum class Standing { stranger, familiar };

/// At most `threads` requests of a lane are handled at once. So many more wait; the next one is
/// answered 503 with Retry-After.
struct LaneLimits {
  std::size_t threads;
  std::size_t waiting_strangers;
  std::size_t waiting;  ///< strangers and others
};

/// Half of the cores, so that everything else has the other half; at most 8 (512 MiB).
inline LaneLimits hashing_limits() {
  const std::size_t cores = std::thread::hardware_concurrency();
  return {
      .threads = std::clamp<std::size_t>(cores / 2, 1, 8), .waiting_strangers = 8, .waiting = 32};
}

}  // namespace tractus::http
