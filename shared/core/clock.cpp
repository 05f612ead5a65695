#include "core/clock.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <ctime>

namespace tractus {
namespace core {
namespace {
constexpr Instant_ns kSecond = 1'000'000'000;

Instant_ns read(clockid_t id) noexcept {
  timespec t{};
  clock_gettime(id, &t);
  return Instant_ns{t.tv_sec} * kSecond + t.tv_nsec;
}
}  // namespace

Instant_ns MonotonicClock::now() const noexcept { return read(CLOCK_MONOTONIC); }

void MonotonicClock::sleep_until(Instant_ns deadline) noexcept {
  const timespec t{static_cast<time_t>(deadline / kSecond), static_cast<long>(deadline % kSecond)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

std::int64_t utc_us() noexcept { return read(CLOCK_REALTIME) / 1000; }

std::string utc_text(std::int64_t us) {
  const std::time_t seconds = us / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", utc.tm_year + 1900,
                     utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                     us % 1'000'000);
}

}  // namespace core
}  // namespace tractus
