/// Time is a parameter: who needs it is handed a Clock; tests step a ManualClock and never sleep.
#pragma once

#include <cstdint>
#include <string>

namespace tractus::core {

/// Nanoseconds of one monotonic clock. Only differences mean anything.
using Instant_ns = std::int64_t;

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Instant_ns now() const noexcept = 0;
  /// Returns at `deadline` or later; at once when it has passed.
  virtual void sleep_until(Instant_ns deadline) noexcept = 0;
};

/// CLOCK_MONOTONIC with absolute sleeps.
class MonotonicClock final : public Clock {
 public:
  Instant_ns now() const noexcept override;
  void sleep_until(Instant_ns deadline) noexcept override;
};

/// Stands still until told: sleeping jumps to the deadline.
class ManualClock final : public Clock {
 public:
  Instant_ns now() const noexcept override { return now_; }
  void sleep_until(Instant_ns deadline) noexcept override {
    if (deadline > now_) now_ = deadline;
  }
  void advance(Instant_ns by) noexcept { now_ += by; }

 private:
  Instant_ns now_ = 0;
};

/// Wall-clock time of day, UTC, microseconds since 1970: for records that people read, never for
/// intervals.
std::int64_t utc_us() noexcept;
inline constexpr std::int64_t kDay_us = 86'400'000'000;
/// "2026-03-01T12:00:00.123456Z" of such a time.
std::string utc_text(std::int64_t us);

}  // namespace tractus::core
