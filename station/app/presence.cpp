#include "station/app/presence.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/check/findings.hpp"
#include "station/devices/catalogue.hpp"
#include "station/loop/live_state.hpp"
#include "station/uplink/clock_offset.hpp"
#include "station/uplink/live.hpp"

namespace tractus {
namespace app {
namespace {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kDiskEvery{5}, kOutboxEvery{30};

/// The running trial in plain bytes: written by the thread that watches it, read by the uplink's.
struct RunningTrial {
  char trial_id[33] = {}, case_id[65] = {};
  bool probing = false, blind = false;
  double t_s = 0.0, force_N = 0.0, depth_m = 0.0;
  std::uint64_t samples = 0, late = 0;
};

template <std::size_t N>
void put(char (&to)[N], const std::string& from) {
  const std::size_t size = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), size);
  to[size] = '\0';
}

}  // namespace

struct Presence::Parts {
  const Options& options;
  const session::StationFolder& folder;
  session::RemoteSupervisor outside;
  std::atomic<State> state = State::idle;
  loop::Seqlock<RunningTrial> seen;
  std::atomic<std::uint64_t> ticks = 0, late = 0;
  std::string device;
  bool simulated = false;
  std::optional<std::int64_t> calibration_due_utc_us;
  // Of the uplink's thread alone:
  std::optional<uplink::ClockOffset> offset;
  Clock::time_point disk_at, outbox_at;
  std::optional<std::uint64_t> free_bytes, waiting;
  std::unique_ptr<uplink::LiveUplink> line;  ///< last: ends before what its thread uses

  Parts(const Options& given, const session::StationFolder& where) : options(given), folder(where) {
    const bool rig = given.command == run_probing_trials || given.command == run_study;
    device = rig ? given.rig.device : given.setup.device;
    simulated = devices::is_simulated(device);
    if (const auto last = check::Calibration::read(where.calibration_file(device)); last && *last)
      calibration_due_utc_us = (*last)->due_utc_us;
    if (where.config().lowered_force_N) outside.lower_force(*where.config().lowered_force_N);
  }
  wire::StationStatus told();
  void look_around();
  void measure_clock();
  void on_command(const wire::StationCommand& command);
};

void Presence::Parts::look_around() {
  const auto now = Clock::now();
  if (!free_bytes || now - disk_at > kDiskEvery) {
    disk_at = now;
    std::error_code failure;
    const auto space = fs::space(folder.trials(), failure);
    if (!failure) free_bytes = space.available;
  }
  // Many small files: not while a trial runs.
  if (waiting && (now - outbox_at < kOutboxEvery || state == State::trial)) return;
  outbox_at = now;
  if (const auto entries = folder.outbox().entries())
    waiting = static_cast<std::uint64_t>(
        std::ranges::count_if(*entries, [](const uplink::OutboxEntry& entry) {
          return entry.state == uplink::OutboxState::queued;
        }));
}

wire::StationStatus Presence::Parts::told() {
  look_around();
  wire::StationStatus out;
  out.state = state;
  out.version = TRACTUS_VERSION;
  out.device = device;
  out.simulated = simulated;
  out.free_disk_bytes = free_bytes;
  out.waiting_trials = waiting;
  out.calibration_due_utc_us = calibration_due_utc_us;
  if (offset) out.clock_offset_s = offset->offset_s, out.clock_error_s = offset->error_s;
  if (ticks > 0) out.late_share = static_cast<double>(late) / static_cast<double>(ticks);
  const auto now = seen.read();
  if (state != State::trial || !now || now->trial_id[0] == '\0') return out;
  wire::LiveTrial& trial = out.trial.emplace();
  trial.trial_id = now->trial_id;
  trial.case_id = now->case_id;
  trial.rig = now->probing ? trial::Rig::probing : trial::Rig::palpation;
  trial.t_s = now->t_s;
  trial.samples = now->samples;
  trial.late_ticks = now->late;
  if (!now->blind && std::isfinite(now->force_N)) trial.force_N = now->force_N;
  if (!now->blind && std::isfinite(now->depth_m)) trial.depth_m = now->depth_m;
  return out;
}

/// Compares the clocks before the first word; what fails is tried at the next line.
void Presence::Parts::measure_clock() {
  auto server = connect(options);
  if (!server) return;
  core::MonotonicClock clock;
  if (auto measured = uplink::measure_clock(**server, clock, core::utc_us)) {
    offset = *measured;
    uplink::keep_clock(folder.clock(), *measured);
  }
}

void Presence::Parts::on_command(const wire::StationCommand& command) {
  if (command.kind == wire::StationCommand::Kind::stop) {
    outside.stop(command.reason);
    return;
  }
  outside.lower_force(command.force_N);
  if (auto kept = folder.lower_force(command.force_N); !kept)
    fmt::print(stderr, "warning: the lower limit holds for this program alone: {}\n",
               kept.error().what);
}

Presence::Presence(const Options& options, const session::StationFolder& folder)
    : parts_(std::make_unique<Parts>(options, folder)) {
  Parts& p = *parts_;
  if (options.server_url.empty()) return;
  auto token = token_of(options);
  if (!token) return;  // whoever needs the server says why
  std::string url = options.server_url;
  while (url.ends_with('/')) url.pop_back();
  const uplink::ServerAddress to{.url = url,
                                 .headers = {{"Authorization", "Bearer " + *token}},
                                 .authority = options.authority};
  p.line = std::make_unique<uplink::LiveUplink>(uplink::LiveUplink::Parts{
      .open =
          [to](const std::atomic<bool>& stopped) {
            return uplink::open_server_socket(to, stopped);
          },
      .told = [&p] { return p.told(); },
      .commanded = [&p](const wire::StationCommand& command) { p.on_command(command); },
      .connected = [&p] { p.measure_clock(); }});
}

Presence::~Presence() = default;

session::RemoteSupervisor* Presence::outside() noexcept { return &parts_->outside; }

void Presence::is(State state) noexcept { parts_->state = state; }

session::Watch Presence::watched(session::Watch inner) {
  return [this, inner = std::move(inner)](const session::TrialSnapshot& now) {
    RunningTrial seen;
    put(seen.trial_id, now.header.id);
    put(seen.case_id, now.header.case_id);
    seen.probing = now.header.rig == trial::Rig::probing;
    seen.blind = now.blind;
    seen.t_s = std::max(now.t_s, 0.0);
    seen.force_N = now.force_N;
    seen.depth_m = std::clamp(now.depth_m, -1.0, 1.0);
    seen.samples = now.samples_safe;
    seen.late = now.late;
    parts_->seen.write(seen);
    is(State::trial);
    return !inner || inner(now);
  };
}

void Presence::done(const session::TrialReport& report) {
  parts_->ticks += report.counts.samples;
  parts_->late += report.counts.late;
  if (parts_->outside.stopped())
    is(State::stopped);
  else
    is(report.fault.empty() ? State::idle : State::fault);
}

bool Presence::may_resume() {
  Parts& p = *parts_;
  if (!p.outside.stopped()) return true;
  is(State::stopped);
  fmt::print(stderr, "{}\n", session::stop_message(p.outside));
  if (!::isatty(STDIN_FILENO)) return false;
  fmt::print(stderr, "Look at the device, then press Enter to go on: ");
  std::string line;
  if (!std::getline(std::cin, line)) return false;
  resume();
  return true;
}

void Presence::resume() {
  parts_->outside.resume();
  is(State::idle);
}

}  // namespace app
}  // namespace tractus
