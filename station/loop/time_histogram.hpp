/// How long something took, again and again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/clock.hpp"

namespace tractus::loop {

/// Durations in bins of 1 µs up to 1 ms and one bin for all above. Real-time safe to fill.
class TimeHistogram {
 public:
  void add(core::Instant_ns duration) noexcept {
    const auto bin = duration < 0 ? 0 : duration / 1000;
    ++bins_[std::size_t(bin < kBins - 1 ? bin : kBins - 1)];
    ++count_;
  }
  /// Upper edge of the bin that holds the share-quantile, µs.
  double quantile_us(double share) const noexcept;

 private:
  static constexpr core::Instant_ns kBins = 1001;
  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

}  // namespace tractus::loop
