/// A limit that can be lowered and never raised.
#pragma once

#include <atomic>
#include <limits>

namespace tractus::loop {

/// Infinite until somebody lowers it. From any thread, without a lock; what is no number or
/// negative changes nothing, nor does what is higher.
class DecreasingLimit {
 public:
  DecreasingLimit() = default;
  DecreasingLimit(const DecreasingLimit& other) noexcept : value_(other.value()) {}
  DecreasingLimit& operator=(const DecreasingLimit& other) noexcept {
    value_.store(other.value(), std::memory_order_relaxed);
    return *this;
  }
  void lower(double to) noexcept {
    double now = value();
    while (to >= 0.0 && to < now &&
           !value_.compare_exchange_weak(now, to, std::memory_order_relaxed)) {
    }
  }
  double value() const noexcept { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<double> value_ = std::numeric_limits<double>::infinity();
};

}  // namespace tractus::loop
