/// A ring between exactly two threads.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include "core/require.hpp"

namespace tractus::loop {

/// Single producer, single consumer, bounded, wait-free on both sides. Memory is taken and touched
/// at construction; no call afterwards allocates. When it is full `push` refuses: what that means
/// is the caller's to say.
template <class T>
class Ring {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  /// @param capacity  a power of two.
  explicit Ring(std::size_t capacity) : slots_(capacity), mask_(capacity - 1) {
    core::require(std::has_single_bit(capacity), "a ring's capacity is a power of two");
  }

  /// Producer alone, real-time safe. False when full: the element is not taken.
  bool push(const T& element) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) > mask_) return false;
    slots_[head & mask_] = element;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Consumer alone: moves up to out.size() elements out, in order; returns how many.
  std::size_t pop(std::span<T> out) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t ready = head_.load(std::memory_order_acquire) - tail;
    const std::size_t taken = ready < out.size() ? ready : out.size();
    for (std::size_t i = 0; i < taken; ++i) out[i] = slots_[(tail + i) & mask_];
    tail_.store(tail + taken, std::memory_order_release);
    return taken;
  }

 private:
  static constexpr std::size_t kLine = 64;  // x86-64 cache line: the two indices never share one
  std::vector<T> slots_;
  std::size_t mask_;
  alignas(kLine) std::atomic<std::size_t> head_ = 0;
  alignas(kLine) std::atomic<std::size_t> tail_ = 0;
};

}  // namespace tractus::loop
