/// What every loop of equal periods does: wait for the deadline, measure how late it woke, count.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "core/clock.hpp"
#include "station/loop/time_histogram.hpp"
#include "trial/trial.hpp"

namespace tractus::loop {

/// Calls a tick at absolute deadlines of one clock. A tick is late when it woke more than a quarter
/// period after its deadline. A deadline that passed whole is skipped and counted, never chased.
/// Makes no allocation, lock or log.
class PeriodicLoop {
 public:
  struct Tick {
    core::Instant_ns now = 0;  ///< when it woke
    core::Instant_ns deadline = 0;
    std::uint32_t number = 0;  ///< from 0; a skipped deadline leaves its number out
    bool late = false;
  };

  /// `clock` must outlive this. @param rate_Hz  above 0
  PeriodicLoop(core::Clock& clock, double rate_Hz);

  /// Absolute deadlines from now on, until `stop` or until `goes_on` answers false. Each tick:
  /// `on_tick(const Tick&)`, whose duration is `work`, then `goes_on()`. Both are under the rules
  /// of real time.
  template <class OnTick, class GoesOn>
  void run(const OnTick& on_tick, const GoesOn& goes_on) noexcept {
    start_ = clock_.now();
    Tick tick{.deadline = start_};
    while (!stop_.load(std::memory_order_relaxed)) {
      clock_.sleep_until(tick.deadline);
      tick.now = clock_.now();
      const core::Instant_ns behind = tick.now - tick.deadline;
      tick.late = behind > period_ / 4;
      on_tick(static_cast<const Tick&>(tick));
      wake_.add(behind);
      work_.add(clock_.now() - tick.now);
      if (!goes_on()) break;
      const auto missed = std::uint32_t(std::max(behind, core::Instant_ns{0}) / period_);
      counts_.skipped += missed;
      tick.number += 1 + missed;
      tick.deadline += (1 + core::Instant_ns{missed}) * period_;
    }
  }
  /// From any thread: no tick begins after the one that runs.
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }

  /// By the tick: a sample with these Flag bits.
  /// @param kept  false: the recording could not take it
  void count(std::uint16_t flags, bool kept) noexcept {
    counts_.count(flags);
    lost_ += !kept;
  }

  // The rest is read after `run`, or by the loop's own thread.
  const trial::TickCounts& counts() const noexcept { return counts_; }
  std::uint64_t lost() const noexcept { return lost_; }         ///< samples that were not kept
  const TimeHistogram& wake() const noexcept { return wake_; }  ///< wake-up after the deadline
  const TimeHistogram& work() const noexcept { return work_; }  ///< the whole tick
  core::Instant_ns started() const noexcept { return start_; }
  core::Instant_ns period() const noexcept { return period_; }
  /// Of the periods that were ticked or skipped, s.
  double passed_s() const noexcept {
    return static_cast<double>(counts_.samples + counts_.skipped) / rate_Hz_;
  }

 private:
  core::Clock& clock_;
  double rate_Hz_;
  core::Instant_ns period_, start_ = 0;
  trial::TickCounts counts_;
  std::uint64_t lost_ = 0;
  TimeHistogram wake_, work_;
  std::atomic<bool> stop_ = false;
};

}  // namespace tractus::loop
