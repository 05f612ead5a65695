#include "station/check/rig_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace check {
namespace {
namespace registers = devices::rig;
using devices::Exchange;
using devices::RigCommand;
using devices::RigReading;

constexpr double kQuiet_s = 1.0, kEnable_s = 2.0, kSettle_s = 0.15, kReturn_s = 5.0;
constexpr double kSilence_s = 0.03, kPulse_s = 0.05, kMoving_s = 0.1;
constexpr double kMotion_s = 3.0;  // about, of check_rig_motion

/// Exchanges at the loop's pace.
class Pace {
 public:
  explicit Pace(RigBench& bench)
      : bench_(bench),
        period_(core::Instant_ns(std::llround(1e9 / bench.rate_Hz))),
        next_(bench.clock.now()) {}

  Exchange exchange(const RigCommand& command, RigReading& reading) noexcept {
    bench_.clock.sleep_until(next_);
    at_ = bench_.clock.now();
    next_ = std::max(next_ + period_, at_);
    const core::Instant_ns asked = bench_.wall.now();
    const Exchange how = bench_.device.exchange(command, reading);
    took_ = bench_.wall.now() - asked;
    return how;
  }
  void pause(double for_s) { next_ = bench_.clock.now() + core::Instant_ns(1e9 * for_s); }
  core::Instant_ns at() const { return at_; }
  core::Instant_ns took() const { return took_; }

 private:
  RigBench& bench_;
  core::Instant_ns period_, next_, at_ = 0, took_ = 0;
};

/// Tells how far it has come, now and then.
class Shown {
 public:
  Shown(const RigBench& bench, double for_s)
      : bench_(bench), every_(std::max(1, int(bench.rate_Hz / 30.0))), plan_s_(for_s) {}
  core::Result<void> tick() {
    if (++ticks_ % every_ != 0 || !bench_.progress) return {};
    if (bench_.progress(std::min(1.0, ticks_ / bench_.rate_Hz / plan_s_))) return {};
    return core::Error{core::Errc::cancelled, "stopped"};
  }

 private:
  const RigBench& bench_;
  int every_, ticks_ = 0;
  double plan_s_;
};

/// Moves the stage as the guard lets it.
class RigDriver {
 public:
  explicit RigDriver(RigBench& bench)
      : bench_(bench),
        pace_(bench),
        shown_(bench, kMotion_s),
        guard_(bench.limits, bench.travel_m, 1.0 / bench.rate_Hz) {}
  ~RigDriver() {
    RigReading unread;
    static_cast<void>(bench_.device.exchange({}, unread));
  }
  RigDriver(const RigDriver&) = delete;
  RigDriver& operator=(const RigDriver&) = delete;

  /// One exchange; what is wanted leaves with the next. Errors: unavailable, cancelled.
  core::Result<RigReading> tick(double speed_m_s, double torque_Nm = 0.0) {
    const core::Instant_ns before = pace_.at();
    const Exchange how = pace_.exchange(command_, reading_);
    asked_m_ += sent_m_s_ * 1e-9 * double(pace_.at() - before);
    sent_m_s_ = command_.speed_m_s;
    guard_.see(how, reading_);
    command_ = guard_.pass(speed_m_s, torque_Nm).command;
    if (guard_.latched())
      return core::Error{core::Errc::unavailable,
                         fmt::format("stopped: {}", safety::text_of(guard_.fault()))};
    TRY(shown_.tick());
    return reading_;
  }
  /// For so long; `each` sees every reading and the time since the start of it.
  template <class Each>
  core::Result<void> run(double for_s, double speed_m_s, double torque_Nm, const Each& each) {
    const int ticks = int(for_s * bench_.rate_Hz);
    for (int k = 0; k < ticks; ++k) {
      auto reading = TRY(tick(speed_m_s, torque_Nm));
      each(double(k) / bench_.rate_Hz, reading);
    }
    return {};
  }
  core::Result<void> run(double for_s, double speed_m_s, double torque_Nm = 0.0) {
    return run(for_s, speed_m_s, torque_Nm, [](double, const RigReading&) {});
  }
  core::Result<void> enable() {
    for (int k = 0; k < int(kEnable_s * bench_.rate_Hz); ++k) {
      auto reading = TRY(tick(0.0));
      if (reading.status & registers::kEnabled) return {};
    }
    return core::Error{core::Errc::unavailable, "the rig's drive does not enable"};
  }

  /// Says nothing for a while, then asks with the drive off what has become of it.
  Exchange after_silence(double for_s, RigReading& reading) {
    pace_.pause(for_s);
    command_ = {};
    sent_m_s_ = 0.0;
    return pace_.exchange({}, reading);
  }
  const RigReading& reading() const { return reading_; }
  double asked_m() const { return asked_m_; }  ///< what the speeds sent come to, so far

 private:
  RigBench& bench_;
  Pace pace_;
  Shown shown_;
  loop::ProbingGuard guard_;
  RigReading reading_;
  RigCommand command_;
  double asked_m_ = 0.0, sent_m_s_ = 0.0;
};

/// How a sensor's channel stands while nothing pulls at it.
struct SignalStatistics {
  double sum = 0.0, squares = 0.0;
  int count = 0;
  void add(double value) { sum += value, squares += value * value, ++count; }
  double mean() const { return count ? sum / count : 0.0; }
  double sd() const {
    return count ? std::sqrt(std::max(0.0, squares / count - mean() * mean())) : 0.0;
  }
};

struct Rest {
  SignalStatistics push, twist;
  int asked = 0, answered = 0, garbage = 0;
  std::uint16_t status = 0;
  bool gone = false;
};

void judge_link(const Rest& rest, const Durations& trips, const RigBench& bench,
                const RigGoals& goals, std::vector<Finding>& out) {
  const double lost = 1.0 - double(rest.answered) / double(std::max(1, rest.asked));
  out.push_back(
      {.name = "link, answers lost",
       .passed = rest.answered > 0 && lost <= goals.lost_share,
       .value = lost,
       .limit = goals.lost_share,
       .unit = "",
       .words =
           rest.gone ? "the line was closed: look at the cable and the rig's supply"
           : rest.garbage > 0
               ? fmt::format("{} answers were none: is this the rig's address?", rest.garbage)
               : fmt::format(
                     "of {} questions{}", rest.asked,
                     lost <= goals.lost_share ? "" : ": look at the cable; no switch between")});
  const double period_s = 1.0 / bench.rate_Hz, p99_s = trips.quantile_s(0.99);
  const bool fits = !trips.empty() && p99_s <= period_s;
  out.push_back({.name = "link round trip",
                 .passed = fits,
                 .value = p99_s,
                 .limit = period_s,
                 .unit = "s",
                 .words = trips.text() + (fits ? "" : ": longer than a period of the loop")});
}

void judge_sensor(const Rest& rest, const RigGoals& goals, std::vector<Finding>& out) {
  const auto zero = [&](const char* name, double value, double limit, const char* unit) {
    const bool fine = std::abs(value) <= limit;
    out.push_back({.name = name,
                   .passed = fine,
                   .value = value,
                   .limit = limit,
                   .unit = unit,
                   .words = fine ? "with nobody on the probe"
                                 : "with nobody on the probe: take off what hangs on it; else "
                                   "the sensor was overloaded"});
  };
  zero("sensor zero, push", rest.push.mean(), goals.zero_N, "N");
  zero("sensor zero, torque", rest.twist.mean(), goals.zero_Nm, "N·m");
  const bool quiet = rest.push.sd() <= goals.noise_N;
  out.push_back({.name = "sensor noise",
                 .passed = quiet,
                 .value = rest.push.sd(),
                 .limit = goals.noise_N,
                 .unit = "N",
                 .words = quiet ? "standard deviation of the push"
                                : "look at the sensor's cable and its shield"});
}

void judge_travel(double gone_m, double asked_m, const RigGoals& goals, std::vector<Finding>& out) {
  const double off_m = gone_m - asked_m;
  const bool moved = gone_m > 0.5 * asked_m, fine = std::abs(off_m) <= goals.way_error_m;
  out.push_back({.name = "small travel",
                 .passed = fine,
                 .value = std::abs(off_m),
                 .limit = goals.way_error_m,
                 .unit = "m",
                 .words = fmt::format("{:.2f} mm were asked for, it went {:.2f} mm inwards{}",
                                      1e3 * asked_m, 1e3 * gone_m,
                                      fine    ? ""
                                      : moved ? ": look at the spindle and its coupling"
                                              : ": the drive does not follow, or the wrong way")});
}

void judge_rise(const std::vector<std::pair<double, double>>& speeds, const RigGoals& goals,
                std::vector<Finding>& out) {
  const auto time_at = [&](double share) {
    const auto at = std::ranges::find_if(
        speeds, [&](const auto& p) { return p.second >= share * goals.speed_m_s; });
    return at == speeds.end() ? -1.0 : at->first;
  };
  const double from_s = time_at(0.1), to_s = time_at(0.9);
  Finding found{.name = "step of speed, rise time", .limit = goals.rise_s, .unit = "s"};
  if (to_s < 0.0) {
    found.words = "it never reached the speed that was asked for";
  } else {
    found.value = to_s - from_s;
    found.passed = *found.value <= goals.rise_s;
    found.words = fmt::format("from a tenth to nine tenths of {} mm/s{}", 1e3 * goals.speed_m_s,
                              found.passed ? "" : ": look for friction on the slide");
  }
  out.push_back(found);
}

core::Result<void> check_travel_in(RigDriver& driver, const RigGoals& goals,
                                   std::vector<Finding>& out) {
  const double from_m = driver.reading().x_m, asked_before_m = driver.asked_m();
  std::vector<std::pair<double, double>> speeds;
  TRY(driver.run(goals.way_m / goals.speed_m_s, goals.speed_m_s, 0.0,
                 [&](double t_s, const RigReading& r) { speeds.emplace_back(t_s, r.speed_m_s); }));
  TRY(driver.run(kSettle_s, 0.0));
  judge_travel(driver.reading().x_m - from_m, driver.asked_m() - asked_before_m, goals, out);
  judge_rise(speeds, goals, out);
  return {};
}

/// Outwards, slowly, and then no word from us: the machine has to stop by itself.
core::Result<void> check_watchdog(RigDriver& driver, const RigGoals& goals,
                                  std::vector<Finding>& out) {
  const double speed_m_s = 0.5 * goals.speed_m_s;
  TRY(driver.run(kMoving_s, -speed_m_s));
  const double last_m = driver.reading().x_m;
  RigReading after;
  const Exchange how = driver.after_silence(kSilence_s, after);
  const bool said = how == Exchange::ok && (after.status & registers::kFaulted) != 0 &&
                    after.fault == registers::RigFault::watchdog;
  const double went_s = std::abs(after.x_m - last_m) / speed_m_s;
  out.push_back({.name = "watchdog of the rig",
                 .passed = said && went_s <= goals.stop_s,
                 .value = went_s,
                 .limit = goals.stop_s,
                 .unit = "s",
                 .words = said
                              ? fmt::format("without a word from us for {:.0f} ms it stopped by "
                                            "itself; so long it went on",
                                            1e3 * kSilence_s)
                              : "without a word from us it did NOT stop by itself: do not use it"});
  return {};
}

core::Result<void> check_return(RigDriver& driver, const RigBench& bench, const RigGoals& goals,
                                std::vector<Finding>& out) {
  TRY(driver.enable());
  for (int k = 0; k < int(kReturn_s * bench.rate_Hz) && driver.reading().x_m > 0.25 * goals.home_m;
       ++k)
    TRY(driver.tick(-goals.speed_m_s));
  TRY(driver.run(kSettle_s, 0.0));
  const double left_m = driver.reading().x_m;
  out.push_back({.name = "return to the entry",
                 .passed = std::abs(left_m) <= goals.home_m,
                 .value = left_m,
                 .limit = goals.home_m,
                 .unit = "m",
                 .words = std::abs(left_m) <= goals.home_m
                              ? "where it stands after the way back"
                              : "it does not come back: look for what blocks the slide"});
  return {};
}

/// A pulse, and one back that stops it.
core::Result<void> check_turn(RigDriver& driver, const RigGoals& goals, std::vector<Finding>& out) {
  const std::int32_t from = driver.reading().angle_urad;
  TRY(driver.run(kPulse_s, 0.0, goals.turn_Nm));
  TRY(driver.run(kPulse_s, 0.0, -goals.turn_Nm));
  TRY(driver.run(kSettle_s, 0.0));
  const auto turned =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(driver.reading().angle_urad) -
                                static_cast<std::uint32_t>(from));  // it wraps
  const double way = 1e-6 * turned;
  out.push_back({.name = "direction of the rotary motor",
                 .passed = way >= goals.least_rad,
                 .value = way,
                 .limit = goals.least_rad,
                 .bound = Bound::at_least,
                 .unit = "rad",
                 .words = fmt::format("a pulse of {} N·m{}", goals.turn_Nm,
                                      way >= goals.least_rad ? " turns it the right way"
                                      : way < -goals.least_rad
                                          ? " turns it the WRONG WAY: its cabling is reversed"
                                          : " does not turn it: is it held, or its motor off?")});
  return {};
}

/// Asks with the drive off until the e-stop is as wanted. False: it was not within the time.
core::Result<bool> await(Pace& pace, Shown& shown, const RigBench& bench, double patience_s,
                         bool pressed) {
  for (int k = 0; k < int(patience_s * bench.rate_Hz); ++k) {
    RigReading reading;
    const Exchange how = pace.exchange({}, reading);
    if (how == Exchange::gone)
      return core::Error{core::Errc::unavailable, "the line to the rig was closed"};
    if (how == Exchange::ok && ((reading.status & registers::kEmergency) != 0) == pressed)
      return true;
    TRY(shown.tick());
  }
  return false;
}
}  // namespace

core::Result<bool> check_rig_at_rest(RigBench bench, const RigGoals& goals,
                                     std::vector<Finding>& out) {
  Pace pace(bench);
  Shown shown(bench, kQuiet_s);
  Rest rest;
  const int ticks = int(kQuiet_s * bench.rate_Hz);
  Durations trips{std::size_t(ticks)};
  for (; rest.asked < ticks && !rest.gone; ++rest.asked) {
    RigReading reading;
    const Exchange how = pace.exchange({}, reading);
    trips.add(pace.took());
    rest.gone = how == Exchange::gone;
    rest.garbage += how == Exchange::garbage;
    TRY(shown.tick());
    if (how != Exchange::ok) continue;
    ++rest.answered;
    rest.status = reading.status;
    rest.push.add(reading.fz_N);
    rest.twist.add(reading.tz_Nm);
  }
  judge_link(rest, trips, bench, goals, out);
  if (rest.answered == 0) return false;
  const bool stopped = rest.status & registers::kEmergency;
  out.push_back({.name = "emergency stop",
                 .passed = !stopped,
                 .value = std::nullopt,
                 .limit = std::nullopt,
                 .unit = "",
                 .words = stopped ? "it is pressed or latched: release the button, press reset at "
                                    "the rig"
                                  : "not latched"});
  judge_sensor(rest, goals, out);
  return !stopped && !rest.gone;
}

core::Result<void> check_rig_motion(RigBench bench, const RigGoals& goals,
                                    std::vector<Finding>& out) {
  RigDriver driver(bench);
  TRY(driver.enable());
  TRY(check_travel_in(driver, goals, out));
  TRY(check_watchdog(driver, goals, out));
  TRY(check_return(driver, bench, goals, out));
  return check_turn(driver, goals, out);
}

core::Result<Finding> check_emergency_stop(RigBench bench, double patience_s,
                                           const std::function<void(const char*)>& tell) {
  Finding out{.name = "emergency stop, pressed"};
  Pace pace(bench);
  Shown shown(bench, 2.0 * patience_s);
  tell("Press the emergency stop now.");
  auto pressed = TRY(await(pace, shown, bench, patience_s, true));
  if (!pressed) {
    out.words = "the rig did not notice it: do not use it";
    return out;
  }
  tell("Release it, and press reset at the rig.");
  auto released = TRY(await(pace, shown, bench, patience_s, false));
  out.passed = released;
  out.words = released ? "noticed when a person pressed it, and released by the reset alone"
                       : "it does not come off: press reset at the rig's panel";
  return out;
}

}  // namespace check
}  // namespace tractus
