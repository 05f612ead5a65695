/// What a test tells the stand-in, and what it saw.
#pragma once

#include <atomic>
#include <cstdint>

#include "tests/support/mapped_page.hpp"  // how both come by it

namespace tractus::standin {

struct Control {
  // Commands.
  std::atomic<int> plugged{1};      ///< 0: every call ends with a communication error
  std::atomic<int> in_use{0};       ///< another program has it: open is refused
  std::atomic<int> initialised{1};  ///< 0: has lost its zero until drdAutoInit
  std::atomic<int> active_wrist{1};
  std::atomic<int> stuck{0};            ///< samples do not change any more: "time guard"
  std::atomic<int> force_off_cause{0};  ///< the device took its forces away
  std::atomic<int> error{0};            ///< the next calls fail with this code
  /// Of each motor, x y z and about them: what comes of a command. −1: reversed; 0: no force.
  std::atomic<double> motor[6]{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  std::atomic<unsigned> jammed{0};  ///< a bit for each of the same six: it does not move
  std::atomic<unsigned> buttons{0};
  std::atomic<double> hand_m[3]{};  ///< where the hand wants the handle
  std::atomic<double> hand_N_per_m{350.0};
  /// For a second after opening the hand moves to and fro, so far from there along each axis.
  std::atomic<double> roaming_m{0.0};
  std::atomic<double> gap_m{0.012};
  std::atomic<std::int64_t> step_ns{0};  ///< of its own time a read; 0: the monotonic clock's
  // Seen.
  std::atomic<double> force_N[3]{}, torque_Nm[3]{}, handle_m[3]{};
  std::atomic<int> force_on{0}, gravity{0}, watchdog_steps{0}, opened{0}, stops{0};
  std::atomic<int> velocity_guard_writes{0}, watchdog_trips{0}, homings{0};
  std::atomic<std::uint64_t> reads{0}, writes{0};
};

}  // namespace tractus::standin
