/// What the tests of the loops share.
#pragma once

#include <algorithm>
#include <vector>

#include "core/clock.hpp"

namespace tractus::loop {

/// A clock that wakes as late as it is told, sleep by sleep.
class StumblingClock final : public core::Clock {
 public:
  core::Instant_ns now() const noexcept override { return now_; }
  void sleep_until(core::Instant_ns deadline) noexcept override {
    now_ = std::max(now_, deadline);
    if (sleeps_ < late_ns.size()) now_ += late_ns[sleeps_];
    ++sleeps_;
  }
  void advance(core::Instant_ns by) noexcept { now_ += by; }
  std::vector<core::Instant_ns> late_ns;

 private:
  core::Instant_ns now_ = 7'000'000'000;
  std::size_t sleeps_ = 0;
};

}  // namespace tractus::loop
