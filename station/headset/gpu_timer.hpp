/// How long the GPU worked on a frame, asked without waiting for it.
#pragma once

#include <array>
#include <optional>

namespace tractus::headset {

/// Timer queries, in turns: what is asked for after a frame is the frame before. The context is
/// current wherever this is used.
class GpuTimer {
 public:
  GpuTimer();
  ~GpuTimer();
  GpuTimer(const GpuTimer&) = delete;
  GpuTimer& operator=(const GpuTimer&) = delete;

  /// Round one eye's picture; not nested.
  void begin();
  void end();
  /// After both eyes. Time of the frame before, s; nothing when the GPU is not through with it.
  std::optional<double> frame_s();

 private:
  static constexpr int kEyes = 2;
  std::array<std::array<unsigned, kEyes>, 2> queries_{};
  std::array<int, 2> asked_{};  ///< queries used of either turn
  int turn_ = 0;
};

}  // namespace tractus::headset
