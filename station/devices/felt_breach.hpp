/// What the SIMULATED surgeon makes of what its hand felt: was there a breach? Not a measurement of
/// anyone.
#pragma once

#include <cstdint>

#include "station/devices/catalogue.hpp"

namespace tractus::devices {

/// Fed with what a hand feels on the probe and nothing else: push and speed, never the controller's
/// mode. A breach is felt as a jump while it pushes: the speed over 50 ms against that of the last
/// second. The logarithm of the largest ratio is perceived with a seeded noise that falls with
/// skill (Weber's law); above ln 5 the answer is a breach, and the distance to it is the
/// confidence. All numbers are plausible choices of ours.
class FeltBreach {
 public:
  FeltBreach(std::uint64_t seed, double skill, double period_s);
  /// Every tick in which the probe may move. No allocation.
  void feel(double speed_m_s, double push_N, double x_m) noexcept;
  /// The depth at which the strongest jump was felt, as a hand remembers it: off by a few
  /// millimetres, less with skill. Meant where the answer is a breach.
  double depth_m() const noexcept;
  /// The wall is always the lateral one, the only one that a rig without a direction can mean.
  SimulatedAnswer answer() const noexcept;

 private:
  std::uint64_t seed_;
  double skill_, quick_, slow_;             // shares per tick of the two running means
  double speed_m_s_ = 0.0, push_N_ = 0.0;   // felt now
  double usual_m_s_ = 0.0, usual_N_ = 0.0;  // of the last second
  double settled_ = 0.0;                    // 0 … 1: how much of that second has been felt
  double strongest_ = 0.0, strongest_m_ = 0.0;
};

}  // namespace tractus::devices
