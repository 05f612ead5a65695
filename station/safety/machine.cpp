#include "station/safety/machine.hpp"

#include <algorithm>

namespace tractus::safety {

Output Machine::take(Event event) noexcept {
  const Step& step = kTable[std::size_t(memory_.state)][std::size_t(event)];
  if (step.to != memory_.state) memory_.quiet_ticks = 0, memory_.ramped_ns = 0;
  memory_.state = step.to;
  return step.output;
}

void Machine::arm() noexcept {
  memory_ = {.state = memory_.state};
  take(Event::arm);
}

void Machine::fail(Fault fault) noexcept {
  const bool latched = memory_.state == State::latched;
  take(Event::fault);
  if (!latched && memory_.state == State::latched) memory_.fault = fault;
}

// Counts, and says what of it this tick comes to.
Event Machine::event_of(core::Instant_ns elapsed, const TickInput& seen) noexcept {
  Memory& m = memory_;
  const core::Instant_ns most = timing_.stale_latch_ns + 1;  // capped: more says nothing new
  m.silent_ns = seen.fresh ? 0 : std::min(m.silent_ns + elapsed, most);
  if (seen.fault != Fault::none || m.silent_ns == most) return Event::fault;
  if (!seen.fresh) {
    m.quiet_ticks = 0;
    if (m.state == State::ramping) m.ramped_ns = std::min(m.ramped_ns + elapsed, timing_.ramp_ns);
    return Event::stale;
  }
  if (!seen.ready) {
    m.quiet_ticks = 0;
    return Event::unready;
  }
  if (m.state == State::waiting)
    return ++m.quiet_ticks < timing_.quiet_ticks ? Event::settling : Event::ready;
  if (m.state != State::ramping) return Event::ready;
  m.ramped_ns = std::min(m.ramped_ns + elapsed, timing_.ramp_ns);
  return m.ramped_ns >= timing_.ramp_ns ? Event::ramped : Event::ready;
}

double Machine::tick(core::Instant_ns elapsed, const TickInput& seen) noexcept {
  const Event event = event_of(std::max(elapsed, core::Instant_ns{0}), seen);
  if (event == Event::fault) {
    fail(seen.fault != Fault::none ? seen.fault : timing_.when_stale);
    return 0.0;
  }
  switch (take(event)) {
    case Output::zero:
      return 0.0;
    case Output::share_of_ramp:
      return timing_.ramp_ns > 0 ? double(memory_.ramped_ns) / double(timing_.ramp_ns) : 0.0;
    case Output::all:
      return 1.0;
  }
  return 0.0;
}

}  // namespace tractus::safety
