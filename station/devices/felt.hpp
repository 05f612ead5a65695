/// What a simulated hand remembers of the forces it felt, and what it makes of them.
#pragma once

#include <array>
#include <cstdint>

#include "station/devices/palpation_plan.hpp"

namespace tractus::devices {

/// Bins of felt resistance. `note` runs in the tick: fixed size, no allocation.
///
/// In a stroke the hand leans on a wall: whole walls give back about the same push per millimetre
/// of lean at a given depth, a hole gives back little: where one wall's push is under a quarter
/// of what the four give at that depth, the answer is a breach there. Else, if a tap goes farther
/// beyond the planned end than the sides gave way before they held (soft bone yields everywhere),
/// it is one in front. Each push and the tap carry a Weber noise of a tenth, seeded. It sees
/// nothing else. Thresholds are choices of ours.
class FeltResistance {
 public:
  static constexpr int kBins = 10;

  /// @param share         0 … 1 of the strokes' range of depth; unused for a tap
  /// @param lean_m        how far the straight tip is beyond the channel's wall, or its end
  /// @param resistance_N  the device's push against the hand, against the press of a stroke
  void note(const Intent& intent, double share, double lean_m, double resistance_N) noexcept;

  SimulatedAnswer answer(std::uint64_t seed) const noexcept;

 private:
  static constexpr double kMinLean_m = 0.0005;
  struct Bin {
    double resistance_N = 0.0, lean_m = 0.0;
    std::uint32_t count = 0;
    Bin& operator+=(const Bin& other) noexcept;
  };
  struct Weakest {
    double share = 1e9;
    std::size_t wall = 0;
  };
  Bin place(std::size_t wall, std::size_t first, std::size_t bins) const noexcept;
  Weakest weakest(std::uint64_t& random) const noexcept;
  double side_give_m() const noexcept;

  std::array<std::array<Bin, kBins>, 4> walls_{};
  double tap_lean_m_ = 0.0;  ///< farthest beyond the end
};

}  // namespace tractus::devices
