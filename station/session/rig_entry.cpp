#include "station/session/rig_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace session {
namespace {
namespace registers = devices::rig;
using devices::Exchange;

constexpr double kBack_m_s = 0.02, kAtEntry_m = 2e-5, kHandOn_N = 30.0;
constexpr double kLongest_s = 10.0;
constexpr double kLetGo_s = 0.5;  // a hand that went along with the stage lets go of it meanwhile
constexpr int kMostSilent = 50, kResets = 10;

core::Error not_ready(const std::string& why) {
  return {core::Errc::unavailable, "the rig is not ready: " + why};
}

/// Exchanges at the loop's pace.
class Way {
 public:
  Way(devices::RigDevice& device, core::Clock& clock, double rate_Hz)
      : device_(device),
        clock_(clock),
        period_(core::Instant_ns(1e9 / rate_Hz)),
        next_(clock.now()) {}

  core::Result<devices::RigReading> ask(const devices::RigCommand& command) {
    for (int silent = 0; silent < kMostSilent; ++silent) {
      clock_.sleep_until(next_);
      next_ = std::max(next_ + period_, clock_.now());
      devices::RigReading reading;
      const Exchange how = device_.exchange(command, reading);
      if (how == Exchange::ok && (reading.status & registers::kEmergency))
        return not_ready("emergency stop; release the button and press reset at the rig");
      if (how == Exchange::ok) return reading;
      if (how == Exchange::gone) return not_ready("the line to it was closed");
      if (how == Exchange::garbage) return not_ready("it answers with something that is no answer");
    }
    return not_ready("it does not answer");
  }

 private:
  devices::RigDevice& device_;
  core::Clock& clock_;
  core::Instant_ns period_, next_;
};

core::Result<devices::RigReading> cleared(Way& way) {
  auto reading = way.ask({});
  for (int k = 0; reading && (reading->status & registers::kFaulted); ++k) {
    if (k == kResets) return not_ready(fmt::format("fault {} does not clear", int(reading->fault)));
    TRY(way.ask({.reset_fault = true}));
    reading = way.ask({});
  }
  return reading;
}

}  // namespace

core::Result<void> bring_to_entry(devices::RigDevice& device, core::Clock& clock, double rate_Hz) {
  Way way(device, clock, rate_Hz);
  auto reading = cleared(way);
  if (!reading) return reading.error();
  const int most = int(kLongest_s * rate_Hz);
  const bool moved = reading->x_m > kAtEntry_m;
  for (int k = 0; reading->x_m > kAtEntry_m; ++k) {
    if (k == most) return not_ready(fmt::format("the stage stands at {:.4f} m", reading->x_m));
    if (std::abs(reading->fz_N) > kHandOn_N) {
      static_cast<void>(way.ask({}));
      return not_ready("let go of the probe while the stage returns to the entry");
    }
    // The drive enables with the first command and stops by itself should these cease.
    const double speed = -std::min(kBack_m_s, 0.001 + reading->x_m / 0.05);
    reading = way.ask({.speed_m_s = speed, .enable = true});
    if (!reading) return reading.error();
    if (reading->status & registers::kFaulted) {
      reading = cleared(way);
      if (!reading) return reading.error();
    }
  }
  const int still = moved ? int(kLetGo_s * rate_Hz) : 1;
  for (int k = 0; reading && k < still; ++k) reading = way.ask({});
  if (!reading) return reading.error();
  return {};
}

}  // namespace session
}  // namespace tractus
