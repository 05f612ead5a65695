/// What a simulated hand remembers of the forces it felt, and what it makes of them.
#pragma once

#include <array>
#include <cstdint>

#include "station/devices/palpation_plan.hpp"

namespace devices {

/// Bins of felt resistance. `note` runs in the tick: fixed size, no allocation.
///
/// In a stroke the hand leans on a wall: a whole wall gives back about the same push per millimetre
/// of lean at a given depth on all four sides, a hole gives back little. At the end a whole bone
/// stops the tap, a hole lets it through. The answer compares these, with a Weber noise on each (a
/// tenth: own choice), seeded. It sees nothing else.
class FeltResistance {
 public:
  static constexpr int kBins = 10;

  /// @param resistance_N  the device's push against the hand along the press (stroke) or out of the
  /// bone (tap)
  /// @param lean_m        how far the straight tip is beyond the channel's wall, or beyond its end
  /// @param share         0 … 1 of the strokes' range of depth; unused for a tap
  void note(const Intent& intent, double share, double lean_m, double resistance_N) noexcept;

  Answer answer(std::uint64_t seed) const noexcept;

 private:
  struct Bin {
    double resistance_N = 0.0, lean_m = 0.0;
    std::uint32_t count = 0;
  };
  std::array<std::array<Bin, kBins>, 4> walls_{};
  double tap_resistance_N_ = 0.0;  ///< strongest felt in a tap
  double tap_lean_m_ = 0.0;        ///< farthest beyond the end
  std::uint32_t taps_ = 0;
};

}  // namespace devices
