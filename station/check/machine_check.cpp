#include "station/check/machine_check.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/check/durations.hpp"

namespace tractus {
namespace check {
namespace {
constexpr double kLateShare = 0.001;
constexpr double kFlush_s = 0.015;  // the recorder's 20 ms less the 5 ms that it waits
constexpr double kRoom_bytes = 2e9;
constexpr double kGranularity_s = 1e-6;
constexpr double kTimeOfDay_s = 1.0;
constexpr core::Instant_ns kShownEvery_ns = 30'000'000;
constexpr int kFlushes = 100, kReadings = 100'000;

std::string of(const loop::RealtimeGrant& grant) {
  return grant.fifo ? "with real-time priority"
                    : "WITHOUT real-time priority: grant it (limits.d, rtprio)";
}

/// How long one block takes to the disk.
core::Result<Durations> flushes(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0600);
  if (fd < 0) return core::system_error(file, "cannot write");
  const std::array<char, 4096> block{};
  core::MonotonicClock clock;
  Durations took(kFlushes);
  bool fine = true;
  for (int k = 0; k < kFlushes && fine; ++k) {
    const core::Instant_ns start = clock.now();
    fine = ::write(fd, block.data(), block.size()) == ssize_t(block.size()) && ::fdatasync(fd) == 0;
    took.add(clock.now() - start);
  }
  const core::Error failed = core::system_error(file, "cannot write");
  ::close(fd);
  ::unlink(file.c_str());
  if (!fine) return failed;
  return took;
}

/// What the loop's thread saw.
struct Woken {
  loop::RealtimeGrant grant;
  Durations behind;
  std::uint64_t late = 0, ticks = 0;
  std::atomic<bool> stop = false, done = false;
};

void wake_up(double rate_Hz, double for_s, Woken& out) {
  const loop::Realtime realtime;
  out.grant = realtime.grant();
  core::MonotonicClock clock;
  const auto period = core::Instant_ns(std::llround(1e9 / rate_Hz));
  core::Instant_ns deadline = clock.now();
  const core::Instant_ns end = deadline + core::Instant_ns(for_s * 1e9);
  for (; deadline < end && !out.stop; ++out.ticks) {
    clock.sleep_until(deadline);
    const core::Instant_ns behind = std::max(clock.now() - deadline, core::Instant_ns{0});
    out.behind.add(behind);
    out.late += behind > period / 4;
    deadline += (1 + behind / period) * period;
  }
  out.done = true;
}
}  // namespace

Finding check_wake_ups(double rate_Hz, double for_s, const std::function<bool(double)>& progress) {
  Woken seen{.grant = {}, .behind = Durations(std::size_t(rate_Hz * for_s) + 1)};
  core::MonotonicClock clock;
  const core::Instant_ns start = clock.now();
  std::thread thread([&] { wake_up(rate_Hz, for_s, seen); });
  for (; !seen.done; clock.sleep_until(clock.now() + kShownEvery_ns))
    if (progress && !progress(std::min(1.0, 1e-9 * double(clock.now() - start) / for_s)))
      seen.stop = true;
  thread.join();
  const double share = seen.ticks ? double(seen.late) / double(seen.ticks) : 1.0;
  return {
      .name = "wake-ups of the loop",
      .passed = share <= kLateShare,
      .value = share,
      .limit = kLateShare,
      .unit = "",
      .words = fmt::format("{} of {} came a quarter period late or later at {:.0f} Hz, {}; {}{}",
                           seen.late, seen.ticks, rate_Hz, of(seen.grant), seen.behind.text(),
                           share <= kLateShare ? "" : "; end what else this machine does")};
}

core::Result<void> check_disk(const std::filesystem::path& folder, std::vector<Finding>& out) {
  auto took = TRY(flushes(folder / (core::new_id() + ".part")));
  const double slow_s = took.quantile_s(0.99);
  const bool fast = slow_s <= kFlush_s;
  out.push_back({.name = "disk, to be safe",
                 .passed = fast,
                 .value = slow_s,
                 .limit = kFlush_s,
                 .unit = "s",
                 .words = fmt::format("4 KiB written and flushed: {}{}", took.text(),
                                      fast ? "" : "; another disk, or less that writes to it")});
  std::error_code failed;
  const auto space = std::filesystem::space(folder, failed);
  const double room = failed ? 0.0 : double(space.available);
  out.push_back({.name = "disk, room",
                 .passed = room >= kRoom_bytes,
                 .value = room,
                 .limit = kRoom_bytes,
                 .bound = Bound::at_least,
                 .unit = "B",
                 .words = fmt::format("{:.1f} GB free{}", 1e-9 * room,
                                      room >= kRoom_bytes ? "" : ": hand over trials, make room")});
  return {};
}

Finding check_clock() {
  core::MonotonicClock clock;
  bool forwards = true;
  core::Instant_ns finest = 1'000'000'000, last = clock.now();
  for (int k = 0; k < kReadings; ++k) {
    const core::Instant_ns now = clock.now();
    forwards = forwards && now >= last;
    if (now > last) finest = std::min(finest, now - last);
    last = now;
  }
  const double step_s = 1e-9 * double(finest);
  return {.name = "clock",
          .passed = forwards && step_s <= kGranularity_s,
          .value = step_s,
          .limit = kGranularity_s,
          .unit = "s",
          .words = !forwards ? "the monotonic clock ran backwards: do not use this machine"
                   : step_s <= kGranularity_s
                       ? "the monotonic clock runs forwards, in steps no larger than that"
                       : "the monotonic clock is too coarse: look at the kernel's clock source"};
}

Finding check_time_of_day(const std::optional<Offset>& server) {
  Finding out{.name = "time of day"};
  if (server) {
    out.value = server->offset_s;
    out.limit = kTimeOfDay_s;
    out.unit = "s";
    out.passed = std::abs(server->offset_s) <= kTimeOfDay_s + server->error_s;
    out.words = fmt::format("the server's clock less ours, to {:.2g} s{}", server->error_s,
                            out.passed ? "" : ": switch on network time");
    return out;
  }
  timex time{};
  out.passed = ::adjtimex(&time) != TIME_ERROR;
  out.words = out.passed ? "the system keeps it right by the network"
                         : "nothing keeps it right: switch on network time, or name the server "
                           "(--server) to compare with";
  return out;
}

Finding check_calibration(const std::optional<Calibration>& last, std::int64_t now_utc_us,
                          Tested tested) {
  Finding out{.name = "calibration"};
  if (!last) {
    out.words = "never calibrated: run `tractus-station calibrate`";
    return out;
  }
  if (last->simulated && tested == Tested::machine) {
    out.words = fmt::format("that of {} was of a SIMULATED device: run `tractus-station calibrate`",
                            day_of(last->at_utc_us));
    return out;
  }
  out.passed = last->due_utc_us > now_utc_us;
  out.words = fmt::format("{} by {}, {} {}{}", day_of(last->at_utc_us), last->who,
                          out.passed ? "due" : "OVERDUE since", day_of(last->due_utc_us),
                          out.passed ? "" : ": run `tractus-station calibrate`");
  return out;
}

}  // namespace check
}  // namespace tractus
