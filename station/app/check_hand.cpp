/// Self-test and calibration of a haptic device.
#include <fmt/format.h>

#include <cmath>

#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus {
namespace app {
namespace {
constexpr double kSimulatedTravel_m = 0.001;  // a simulated hand stays in its channel
constexpr double kLongPlan_s = 3600.0;

/// A device opened, with its limiter and its clock: real time for a machine, as fast as it goes for
/// a simulated hand's.
struct Opened {
  devices::MadeDevice made;
  devices::Limits limits;
  bool hand_simulated = false;  ///< its time is simulated too
  std::unique_ptr<core::Clock> clock;
  core::MonotonicClock wall;
  std::optional<loop::Limiter> limiter;

  Opened() = default;
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    if (made.device) made.device->close();
  }
  bool simulated() const { return hand_simulated || limits.simulated; }
  check::Bench bench(std::function<bool(double)> progress) {
    return {*clock, wall, *made.device, *limiter, limits.rate_Hz, std::move(progress)};
  }
};

core::Result<std::unique_ptr<Opened>> open_device(const Checked& checked, double plan_s,
                                                  devices::Homing homing) {
  const session::TrialSetup& setup = checked.options.setup;
  auto info = TRY(devices::find(setup.device, devices::DeviceKind::handle));
  auto out = std::make_unique<Opened>();
  auto made = TRY(info.make({.duration_s = plan_s, .sdk = setup.sdk, .homing = homing}));
  out->made = std::move(made);
  auto limits = TRY(out->made.device->open());
  out->limits = limits;
  out->hand_simulated = info.simulated;
  if (out->limits.name.empty()) out->limits.name = info.id;
  if (info.simulated)
    out->clock = std::make_unique<core::ManualClock>();
  else
    out->clock = std::make_unique<core::MonotonicClock>();
  out->limiter.emplace(checked.folder.config().limits,
                       core::Instant_ns(std::llround(1e9 / out->limits.rate_Hz)));
  out->limiter->cap_force(checked.outside.force_N());
  return out;
}

/// One of the library's checks over this device, as a trial's loop would run it.
template <class Check>
core::Result<void> run_check(const char* label, Checked& checked, Opened& opened,
                             const Check& check) {
  return run_shown(
      label, opened.hand_simulated ? Pace::as_fast_as_it_goes : Pace::real_time, checked.outside,
      [&](const std::function<bool(double)>& progress) { return check(opened.bench(progress)); },
      [&] { opened.limiter->cap_force(checked.outside.force_N()); });
}

core::Result<void> tell(const Checked& checked, const Opened& opened, const char* what) {
  return opened.simulated() ? core::Result<void>() : checked.ask(what);
}

core::Result<void> travel(Checked& checked) {
  auto opened = TRY(open_device(checked, checked.options.for_s, devices::Homing::refuse));
  checked.device = opened->limits.name;
  checked.simulated = opened->simulated();
  check::DeviceGoals goals;
  if (opened->hand_simulated) goals.travel_m = kSimulatedTravel_m;
  const std::string what =
      fmt::format("Nothing will push. Take the handle and, for {:.0f} s, move it to every end.",
                  checked.options.for_s);
  TRY(tell(checked, *opened, what.c_str()));
  return run_check("Travel", checked, *opened, [&](const check::Bench& bench) {
    return check::check_travel(bench, goals, checked.options.for_s, checked.findings);
  });
}

core::Result<void> forces(Checked& checked, Opened& opened) {
  TRY(tell(checked, opened,
           "Hold the handle loosely in the middle; it will be pushed and turned "
           "gently, with a newton, for ten seconds."));
  return run_check("Forces", checked, opened, [&](const check::Bench& bench) {
    return check::check_forces(bench, {}, checked.findings);
  });
}
}  // namespace

core::Result<void> self_test_hand(Checked& checked) {
  TRY(travel(checked));
  auto opened = TRY(open_device(checked, kLongPlan_s, devices::Homing::refuse));
  return forces(checked, *opened);
}

core::Result<void> calibrate_hand(Checked& checked) {
  auto info = TRY(devices::find(checked.options.setup.device, devices::DeviceKind::handle));
  if (!info.simulated)
    TRY(checked.ask(
        "The handle will move by itself to find its zero: clear its way and keep hands off."));
  auto opened = TRY(open_device(checked, kLongPlan_s, devices::Homing::move));
  checked.device = opened->limits.name;
  checked.simulated = opened->simulated();
  return forces(checked, *opened);
}

}  // namespace app
}  // namespace tractus
