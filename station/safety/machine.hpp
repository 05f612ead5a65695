/// Whether a hand may be given anything: a state machine as data.
#pragma once

#include <array>
#include <cstdint>

#include "core/clock.hpp"
#include "station/safety/fault.hpp"

namespace tractus::safety {

enum class State : std::uint8_t {
  off,      ///< zero; waits for a person to arm
  waiting,  ///< zero until nothing stands in the way of a start for a moment
  ramping,  ///< a growing share
  on,
  latched,  ///< zero after a fault; only a person arms again
};
inline constexpr int kStates = 5;

enum class Event : std::uint8_t {
  arm,       ///< a person's deed
  disarm,    ///< the end of a trial
  fault,     ///< something is wrong for good
  stale,     ///< nothing fresh in this tick
  unready,   ///< fresh, and something stands in the way of a start or of going on
  settling,  ///< fresh and ready, not yet for long enough
  ready,     ///< ready for long enough
  ramped,    ///< and the ramp is over
};
inline constexpr int kEvents = 8;

enum class Output : std::uint8_t { zero, share_of_ramp, all };

struct Step {
  State to;
  Output output;
};

/// What follows in each state on each event: [state][event].
inline constexpr std::array<std::array<Step, kEvents>, kStates> kTable = [] {
  using enum State;
  using enum Output;
  return std::array<std::array<Step, kEvents>, kStates>{{
      // arm, disarm, fault, stale, unready, settling, ready, ramped
      {{{waiting, zero},
        {off, zero},
        {off, zero},
        {off, zero},
        {off, zero},
        {off, zero},
        {off, zero},
        {off, zero}}},  // off
      {{{waiting, zero},
        {off, zero},
        {latched, zero},
        {waiting, zero},
        {waiting, zero},
        {waiting, zero},
        {ramping, share_of_ramp},
        {ramping, share_of_ramp}}},
      {{{waiting, zero},
        {off, zero},
        {latched, zero},
        {ramping, zero},
        {waiting, zero},
        {ramping, share_of_ramp},
        {ramping, share_of_ramp},
        {on, all}}},  // ramping
      {{{waiting, zero},
        {off, zero},
        {latched, zero},
        {on, zero},
        {waiting, zero},
        {on, all},
        {on, all},
        {on, all}}},  // on
      {{{waiting, zero},
        {off, zero},
        {latched, zero},
        {latched, zero},
        {latched, zero},
        {latched, zero},
        {latched, zero},
        {latched, zero}}},  // latched
  }};
}();

/// How long is long enough.
struct Timing {
  int quiet_ticks = 20;                      ///< ready in a row before the ramp begins, >= 1
  core::Instant_ns ramp_ns = 1'000'000'000;  ///< from nothing to all; 0: the tick after
  core::Instant_ns stale_latch_ns =
      20'000'000;  ///< without anything fresh for longer: `when_stale`
  Fault when_stale = Fault::stale;
};

/// What one tick saw.
struct TickInput {
  Fault fault = Fault::none;
  bool fresh = true;
  bool ready = true;
};

/// Real-time safe: a few comparisons, no time but what it is handed. Whatever comes in: 0 in the
/// very tick of a fault and from then on; 0 in a tick without anything fresh; no way out of `off`
/// or `latched` but `arm`; a share that grows by elapsed/ramp a tick at most.
class Machine {
 public:
  explicit Machine(const Timing& timing) noexcept : timing_(timing) {}

  /// A person's deed: forgets a fault, starts from zero.
  void arm() noexcept;
  void disarm() noexcept { take(Event::disarm); }
  /// A fault that was seen beside the tick (a device that refuses a command). The first one stays.
  void fail(Fault fault) noexcept;
  /// One tick. @param elapsed  since the last one, >= 0
  /// @returns the share of what is wanted that may leave, 0 … 1
  double tick(core::Instant_ns elapsed, const TickInput& seen) noexcept;

  /// Lengthens the ramp from now on; cannot shorten it.
  void lengthen_ramp(core::Instant_ns ramp_ns) noexcept {
    if (ramp_ns > timing_.ramp_ns) timing_.ramp_ns = ramp_ns;
  }

  State state() const noexcept { return memory_.state; }
  Fault fault() const noexcept { return memory_.fault; }

  /// All that it remembers, for who compares two.
  struct Memory {
    State state = State::off;
    Fault fault = Fault::none;
    int quiet_ticks = 0;
    core::Instant_ns ramped_ns = 0, silent_ns = 0;
    friend auto operator<=>(const Memory&, const Memory&) = default;
  };
  const Memory& memory() const noexcept { return memory_; }

 private:
  Event event_of(core::Instant_ns elapsed, const TickInput& seen) noexcept;
  Output take(Event event) noexcept;
  Timing timing_;
  Memory memory_;
};

}  // namespace tractus::safety
