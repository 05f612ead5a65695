/// Self-test and calibration of the probing rig.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/devices/catalogue.hpp"
#include "station/session/rig_entry.hpp"

namespace tractus {
namespace app {
namespace {
constexpr double kPatience_s = 30.0;
constexpr const char* kLetGo = "Let go of the probe: nothing moves yet.";
constexpr const char* kKeepClear =
    "Keep clear, hands off: the stage goes to its entry, a centimetre in and out, and the probe "
    "turns.";

struct OpenedRig {
  devices::MadeRig made;
  devices::RigIdentity identity;
  core::MonotonicClock clock;

  explicit OpenedRig(devices::MadeRig rig) : made(std::move(rig)) {}
  OpenedRig(const OpenedRig&) = delete;
  OpenedRig& operator=(const OpenedRig&) = delete;
  ~OpenedRig() { made.device->close(); }
};

core::Result<std::unique_ptr<OpenedRig>> open_rig(Checked& checked) {
  const session::RigSetup& setup = checked.options.rig;
  const auto info = TRY(devices::find(checked.options.setup.device, devices::DeviceKind::rig));
  auto made = TRY(info.make_rig(
      {.address = setup.address, .program = setup.program, .seed = setup.seed, .surgeon = false}));
  auto out = std::make_unique<OpenedRig>(std::move(made));
  const std::string& address = out->made.address;
  auto identity = TRY(out->made.device->open());
  if (identity.bus_clock)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("rig at {}: its clock is on the bus: not for real time", address)};
  out->identity = identity;
  checked.simulated = identity.simulated;
  checked.device = identity.simulated ? "SIMULATED probing rig" : "probing rig at " + address;
  return out;
}

check::RigBench bench_of(const Checked& checked, OpenedRig& rig,
                         std::function<bool(double)> progress) {
  check::RigBench out{.clock = rig.clock,
                      .wall = rig.clock,
                      .device = *rig.made.device,
                      .travel_m = rig.identity.travel_m,
                      .rate_Hz = checked.options.rig.rate_Hz,
                      .progress = std::move(progress)};
  out.limits.max_speed_m_s = std::min(out.limits.max_speed_m_s, rig.identity.top_speed_m_s);
  out.limits.max_push_N = std::min(out.limits.max_push_N, checked.outside.force_N());
  return out;
}

/// Falls silent when somebody stops it: the rig then stands still by its own watchdog.
class Stoppable final : public devices::RigDevice {
 public:
  Stoppable(devices::RigDevice& rig, const std::function<bool(double)>& progress)
      : rig_(rig), progress_(progress) {}
  core::Result<devices::RigIdentity> open() override { return rig_.open(); }
  devices::Exchange exchange(const devices::RigCommand& command,
                             devices::RigReading& reading) noexcept override {
    return progress_(0.0) ? rig_.exchange(command, reading) : devices::Exchange::gone;
  }
  void close() noexcept override { rig_.close(); }

 private:
  devices::RigDevice& rig_;
  const std::function<bool(double)>& progress_;
};

core::Result<void> move(Checked& checked, OpenedRig& rig,
                        const std::function<bool(double)>& progress) {
  Stoppable stoppable(*rig.made.device, progress);
  auto there = session::bring_to_entry(stoppable, rig.clock, checked.options.rig.rate_Hz);
  if (!there && !progress(0.0)) return core::Error{core::Errc::cancelled, "stopped"};
  if (!there) return there;
  return check::check_rig_motion(bench_of(checked, rig, progress), {}, checked.findings);
}

/// With a person there alone: nobody else can press it.
core::Result<void> press_emergency_stop(Checked& checked, OpenedRig& rig) {
  if (checked.simulated || !checked.attended()) return {};
  return run_shown("Emergency stop", Pace::real_time, checked.outside,
                   [&](const std::function<bool(double)>& progress) -> core::Result<void> {
                     auto found = TRY(check::check_emergency_stop(
                         bench_of(checked, rig, progress), kPatience_s,
                         [&](const char* what) { checked.tell(what); }));
                     checked.findings.push_back(std::move(found));
                     return {};
                   });
}

core::Result<void> check_all(Checked& checked, OpenedRig& rig) {
  if (!checked.simulated) TRY(checked.ask(kLetGo));
  bool may_move = false;
  auto rested = run_shown("At rest", Pace::real_time, checked.outside,
                          [&](const std::function<bool(double)>& progress) -> core::Result<void> {
                            auto fine = TRY(check::check_rig_at_rest(
                                bench_of(checked, rig, progress), {}, checked.findings));
                            may_move = fine;
                            return {};
                          });
  if (!rested || !may_move) return rested;
  TRY(press_emergency_stop(checked, rig));
  if (!checked.findings.back().passed && checked.findings.back().name.starts_with("emergency"))
    return {};  // a rig whose e-stop does not work is not moved
  if (!checked.simulated) TRY(checked.ask(kKeepClear));
  return run_shown(
      "Motion", Pace::real_time, checked.outside,
      [&](const std::function<bool(double)>& progress) { return move(checked, rig, progress); });
}
}  // namespace

core::Result<void> check_whole_rig(Checked& checked) {
  auto rig = TRY(open_rig(checked));
  return check_all(checked, *rig);
}

}  // namespace app
}  // namespace tractus
