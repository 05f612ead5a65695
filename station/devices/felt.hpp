/// What a simulated hand remembers of the forces it felt, and what it makes of them.
#pragma once

#include <array>
#include <cstdint>

#include "station/devices/palpation_plan.hpp"

namespace tractus::devices {

/// Standard deviation of a felt force, √(t² + (w F)²), N.
double error_N(const HandSense& sense, double force_N) noexcept;
/// A standard normal number of its own for each key (Box and Muller, on SplitMix64 [Steele2014]).
double normal_of(std::uint64_t key) noexcept;

/// The strokes and taps of one palpation. `note…` run in the tick: fixed size, no allocation.
///
/// A wall is remembered place by place, a millimetre each, every look apart: the mean push back
/// against the press, and the mean push along the axis. Each is wrong by a normal error (`error_N`),
/// seeded and drawn anew every 2 mm of a look. A hole is a place from which the tip comes out with
/// effort in both directions, and at which the wall gives way:
///
///     caught  the push along the axis towards the place, mean over 3 mm to either side, the lesser
///     gives   the push back 4 to 7 mm before and behind, less that within 1.5 mm
///
/// caught + gives/5, and 0.06 N more where the tip went through, is how much a place is like a hole.
/// The places of which the first looks say most are the suspects; they are stroked again, and of
/// these new looks alone the answer is made: the wall of the place that is most like a hole, if it is
/// so by more than a threshold. Places within 6 mm of where bone begins all round are the rim of the
/// mouth and do not count, nor 7 mm more where several walls let the tip through there. Taps that
/// nothing stopped are a breach in front. It sees nothing else. Weights and thresholds are choices of
/// ours.
class FeltWalls {
 public:
  FeltWalls(const DeviceOptions& options);

  /// A tick of a stroke. @param push_N  against the press. @param outward_N  along the axis, out
  void note_stroke(const Intent& intent, double depth_m, double push_N, double outward_N) noexcept;
  /// The wall held up to this depth and then let the tip through.
  void note_through(const Intent& intent, double depth_m) noexcept;
  /// A tick of a tap. @param outward_N  along the axis, out
  void note_tap(double outward_N) noexcept;
  void end_tap() noexcept;

  /// The places that are most like holes, apart from one another.
  std::array<Suspect, PalpationPlan::kSuspects> suspects() const noexcept;
  SimulatedAnswer answer() const;

 private:
  static constexpr int kPlaces = 96;
  static constexpr double kPlace_m = 0.001;
  struct Look {
    float push_N = 0.0f, outward_N = 0.0f;
    std::uint32_t count = 0;
    bool through = false;
  };
  struct Felt {
    double push_N = 0.0, outward_N = 0.0;
    bool through = false;
    bool at_all = false;
  };
  struct Likest {
    std::size_t wall;
    double like_N;
  };
  using Walls = std::array<std::array<Felt, kPlaces>, 4>;
  using Likeness = std::array<std::array<double, kPlaces>, 4>;
  Walls felt(int from_look, int to_look) const noexcept;
  Likeness likeness(const Walls& walls) const noexcept;
  static double likeness_at(const std::array<Felt, kPlaces>& wall, int place) noexcept;
  Likest likest() const noexcept;
  double counts_from_m() const noexcept;

  std::uint64_t seed_;
  HandSense sense_;
  double rim_m_;
  int places_;
  std::array<std::array<std::array<Look, PalpationPlan::kLooks>, kPlaces>, 4> walls_{};
  double tap_N_ = 0.0, taps_N_ = 0.0;
  int taps_ = 0;
};

}  // namespace tractus::devices
