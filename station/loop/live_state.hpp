/// The latest state of a running trial, for whoever looks on.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace tractus::loop {

/// One value written by one thread and read by any number, without a lock: a seqlock [Boehm2012].
/// The writer is wait-free and never sees its readers; a reader that met a write tries again.
template <class T>
class Seqlock {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  /// The one writer, real-time safe.
  void write(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint64_t odd = turn_.load(std::memory_order_relaxed) + 1;
    turn_.store(odd, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_relaxed);
    turn_.store(odd + 1, std::memory_order_release);
  }

  /// Any reader. Nothing before the first write.
  std::optional<T> read() const noexcept {
    std::array<std::uint64_t, kWords> words;
    for (;;) {
      const std::uint64_t before = turn_.load(std::memory_order_acquire);
      if (before == 0) return std::nullopt;
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_relaxed);
      std::atomic_thread_fence(std::memory_order_acquire);
      if (before % 2 == 0 && turn_.load(std::memory_order_relaxed) == before) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return value;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
  std::atomic<std::uint64_t> turn_ = 0;
};

/// What a view draws: poses in V, forces in N, lengths in m.
struct Live {
  double t_s = 0.0;                          ///< since the trial's start
  std::array<double, 3> p_VH_m{};            ///< handle's origin, the model's pose offset applied
  std::array<double, 4> q_VH{1, 0, 0, 0};    ///< w, x, y, z
  std::array<double, 2> deflection_m{};      ///< δ of the tip, in H
  std::array<double, 3> rendered_force_N{};  ///< in H
  std::array<double, 3> rendered_torque_Nm{};
  std::uint32_t tick = 0;
  std::uint32_t late_ticks = 0;
  std::uint32_t buttons = 0;  ///< of the device, a bit each
};

using LiveState = Seqlock<Live>;

}  // namespace tractus::loop
