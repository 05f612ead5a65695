/// How long something took, many times.
#pragma once

#include <string>
#include <vector>

#include "core/clock.hpp"

namespace tractus::check {

/// Adding is real-time safe: beyond the room that was asked for nothing is kept.
class Durations {
 public:
  explicit Durations(std::size_t room) { kept_.reserve(room); }
  void add(core::Instant_ns duration) noexcept {
    if (kept_.size() < kept_.capacity()) kept_.push_back(duration);
  }
  bool empty() const noexcept { return kept_.empty(); }
  std::size_t size() const noexcept { return kept_.size(); }
  /// The smallest that at least `share` of all do not exceed (1: the longest), s; 0 of none.
  double quantile_s(double share) const;
  /// "p50 12 µs, p99 41 µs, longest 130 µs".
  std::string text() const;

 private:
  std::vector<core::Instant_ns> kept_;
};

}  // namespace tractus::check
