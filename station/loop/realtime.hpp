/// Asking the system for real time.
#pragma once

#include <string>
#include <vector>

#include "core/json.hpp"

namespace loop {

/// What the system granted to the calling thread. A refusal is no error: the loop runs on, and the
/// trial says so.
struct RealtimeGrant {
  bool fifo = false;                  ///< SCHED_FIFO
  bool locked = false;                ///< all memory, now and later
  std::vector<std::string> warnings;  ///< one line each, for a person

  core::Json to_json() const;
};

/// Called by the loop's thread before its first tick: FIFO priority 80, mlockall, and the stack
/// touched.
RealtimeGrant prepare_realtime();

}  // namespace loop
