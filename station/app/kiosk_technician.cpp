#include "station/app/kiosk_technician.hpp"

#include <fmt/format.h>

#include <thread>

#include "station/app/checks.hpp"
#include "station/app/exchange.hpp"
#include "station/devices/catalogue.hpp"
#include "station/loop/probing_guard.hpp"

namespace tractus {
namespace app {
namespace {
using core::Instant_ns;
using kiosk::Desk;
using kiosk::Machine;

constexpr auto kLookAtStop = std::chrono::milliseconds(50);
constexpr const char* kStopped = "a technician at the kiosk";

class AtScreen final : public Attendant {
 public:
  explicit AtScreen(Desk& desk) : desk_(desk) {}

  core::Result<void> confirm(const char* what) override {
    desk_.tell([&](Machine& machine, Instant_ns) { machine.instruct(what, true); });
    const bool said =
        desk_.wait([](const Machine& m) { return !m.waits_for_confirmation() || m.stops_test(); },
                   asked_to_stop);
    const bool stops = desk_.look([](const Machine& m) { return m.stops_test(); });
    if (said && !stops) return {};
    return core::Error{core::Errc::cancelled, "stopped"};
  }
  void tell(const char* what) override {
    desk_.tell([&](Machine& machine, Instant_ns) { machine.instruct(what, false); });
  }

 private:
  Desk& desk_;
};

/// Hands a touch of "Stop" to the running check.
class StopTouch {
 public:
  StopTouch(Desk& desk, session::RemoteSupervisor& outside)
      : outside_(outside), thread_([&desk, &outside](const std::stop_token& stop) {
          for (; !stop.stop_requested(); std::this_thread::sleep_for(kLookAtStop))
            if (desk.look([](const Machine& m) { return m.stops_test(); })) outside.stop(kStopped);
        }) {}
  ~StopTouch() {
    thread_.request_stop();
    thread_.join();
    if (outside_.reason() == kStopped) outside_.resume();
  }
  StopTouch(const StopTouch&) = delete;
  StopTouch& operator=(const StopTouch&) = delete;

 private:
  session::RemoteSupervisor& outside_;
  std::jthread thread_;
};
}  // namespace

void test_for_technician(const Options& options, const session::StationFolder& folder,
                         Presence& presence, Desk& desk) {
  presence.is(Presence::State::preparing);
  AtScreen attendant(desk);
  Checked checked{options, folder, *presence.outside()};
  checked.attendant = &attendant;
  std::string why;
  {
    const StopTouch stop(desk, *presence.outside());
    const auto report = test_station(checked);
    if (!report) why = report.error().what;
  }
  core::Json findings = core::Json::array();
  for (const check::Finding& finding : checked.findings) findings.push_back(finding.to_json());
  presence.is(Presence::State::idle);
  desk.tell(
      [&](Machine& machine, Instant_ns now) { machine.tested(std::move(findings), why, now); });
}

core::Json about_station(const Options& options, const session::StationFolder& folder) {
  core::Json out{{"version", TRACTUS_VERSION},
                 {"station", folder.config().name},
                 {"device", options.setup.device},
                 {"limits", core::Json::object()},
                 {"lowered_force_N", core::Json()}};
  out["limits"] = devices::is_rig(options.setup.device) ? loop::RigLimits{}.to_json()
                                                        : folder.config().limits.to_json();
  if (folder.config().lowered_force_N) out["lowered_force_N"] = *folder.config().lowered_force_N;
  return out;
}

std::vector<std::string> newest_trials(const session::StationFolder& folder) {
  constexpr std::size_t kLines = 5;
  std::vector<std::string> out;
  const auto entries = folder.outbox().entries();
  if (!entries) return {entries.error().what};
  for (auto entry = entries->rbegin(); entry != entries->rend() && out.size() < kLines; ++entry)
    out.push_back(fmt::format("{}: {}{}", entry->trial_id, core::name(entry->state),
                              entry->reason.empty() ? "" : ", " + entry->reason));
  return out;
}

}  // namespace app
}  // namespace tractus
