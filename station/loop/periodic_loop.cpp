#include "station/loop/periodic_loop.hpp"

#include <cmath>

namespace tractus::loop {

PeriodicLoop::PeriodicLoop(core::Clock& clock, double rate_Hz)
    : clock_(clock),
      rate_Hz_(rate_Hz),
      period_(static_cast<core::Instant_ns>(std::llround(1e9 / rate_Hz))) {}

}  // namespace tractus::loop
