/// What a simulated hand means to do: a seeded plan of palpation strokes, or of drilling feeds.
#pragma once

#include <cstdint>
#include <vector>

#include "station/devices/catalogue.hpp"

namespace tractus::devices {

enum class Act : std::uint8_t { rest, approach, stroke, tap, drill, withdraw };

/// Where the hand wants the handle, and what for.
struct Intent {
  math::Pose X_DH;
  math::Vec3 velocity_m_s = math::Vec3::Zero();
  Act act = Act::rest;
  int wall = -1;         ///< of a stroke: 0 medial, 1 superior, 2 lateral, 3 inferior
  double depth_m = 0.0;  ///< of the straight probe's tip
  bool button = false;   ///< held: while it drills
  math::Vec3 press = math::Vec3::Zero();  ///< unit vector towards the wall of a stroke, in D
};

/// Approach to the entry, strokes along the four side walls in turn (outward, twice each, the
/// direction sweeping a little to both sides), taps at the end, withdrawal; between key points by
/// minimum jerk [Flash1985]: s = 10τ³ − 15τ⁴ + 6τ⁵. The shank turns about the channel's
/// mouth, as a real one must. Physiological tremor of 8–12 Hz rides on all of it. Amplitudes,
/// speeds and tilts are plausible choices of ours, not measurements.
///
/// With a burr: along the axis from before the bone to a little short of the planned end, in feeds
/// with the button held, each followed by a pause at the bottom, a way back with the button let go
/// and the way in again.
class PalpationPlan {
 public:
  PalpationPlan(const DeviceOptions& options);
  /// At `t_s` since the start; beyond the end, the last point.
  /// @param lean  0 … 1: how much of the plan's tilt the hand dares
  Intent at(double t_s, double lean) const noexcept;
  double duration_s() const noexcept { return keys_.back().t_s; }
  /// How far beyond the channel's end the hand aims in a tap, m.
  static constexpr double kTapBeyond_m = 0.003;
  /// Depth of strokes, m: from the deepest to the shallowest point.
  double deepest_m() const noexcept { return deepest_m_; }
  double shallowest_m() const noexcept { return shallowest_m_; }

 private:
  struct Key {
    double t_s;
    double depth_m;
    double tilt_rad;  ///< towards the wall of the segment that ends here
    Act act;          ///< of the segment that ends here
    int wall;
  };
  struct Wave {
    double amplitude, frequency_rad_s, phase_rad;
  };
  void plan_palpation();
  void plan_drilling();
  void add(double weight_s, double depth_m, double tilt_rad, Act act, int wall = -1);
  double uniform() noexcept;
  math::Pose pose_at(double t_s, double lean, Intent& intent) const noexcept;
  double tremor(int axis, double t_s) const noexcept;

  KnownTract channel_;
  double probe_length_m_, deepest_m_, shallowest_m_;
  std::uint64_t random_;
  std::vector<Key> keys_;
  std::array<std::array<Wave, 3>, 5> tremor_;  // three of position, two of tilt
  double sweep_phase_rad_ = 0.0;
};

}  // namespace tractus::devices
