/// What a simulated hand means to do: a seeded plan of palpation strokes, or of drilling feeds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "station/devices/catalogue.hpp"

namespace tractus::devices {

enum class Act : std::uint8_t { rest, approach, stroke, tap, drill, withdraw };

/// A place of a side wall that felt as if there were a hole.
struct Suspect {
  int wall = 0;  ///< 0 medial, 1 superior, 2 lateral, 3 inferior
  double depth_m = 0.0;
};

/// Where the hand wants the handle, and what for.
struct Intent {
  math::Pose X_DH;
  Act act = Act::rest;
  int wall = -1;                            ///< that is pressed, as in Suspect; none: -1
  int look = -1;                            ///< of a stroke: how often the place was stroked before
  double press = 0.0;                       ///< share of the whole press, 0 … 1
  double depth_m = 0.0;                     ///< of the tip
  bool button = false;                      ///< held: while it drills
  math::Vec3 towards = math::Vec3::Zero();  ///< unit vector towards that wall, in D
};

/// How the hand holds the probe against a wall just now.
struct Grip {
  double bend_m = 0.0;    ///< δ of a whole press
  double firmness = 1.0;  ///< share of it, 0 … 1
  /// Of the plan's depth, from 25 mm before the mouth; less than 1 while it goes out and in again.
  double reach = 1.0;
};

/// Approach to the entry; in, and along each side wall in turn a stroke outwards and one inwards,
/// along the tract's axis, pressed all the way [Zoller2020, Fig. 2]; taps at the end; then,
/// as a surgeon goes back to a place that felt wrong, three more strokes each way over each suspect;
/// withdrawal. Between
/// key points by minimum jerk [Flash1985]: s = 10τ³ − 15τ⁴ + 6τ⁵. Tremor of 8–12 Hz and a slow
/// wander ride on all of it (HandSense). Speeds are plausible choices of ours, not measurements.
///
/// A pressed probe is a cantilever from the handle to its tip, bent by δ, and its end leans by
/// 3δ/2L against the handle. A hand that only moves aside, or only turns the probe about the mouth,
/// therefore bears on the wall with the shank and levers the tip against the opposite one, which it
/// then takes for the wall that it presses. So the hand turns the handle by 3δ/2L as it moves aside,
/// and a little more, that the tip comes first; both stay while the probe slides along the axis.
///
/// With a burr: along the axis from before the bone to a little short of the planned end, in feeds
/// with the button held, each followed by a pause at the bottom, a way back with the button let go
/// and the way in again.
class PalpationPlan {
 public:
  static constexpr int kSuspects = 4;
  static constexpr int kFirstLooks = 2;           ///< out and in, along the whole wall
  static constexpr int kLooks = kFirstLooks + 6;  ///< and those of a recheck

  PalpationPlan(const DeviceOptions& options);
  /// At `t_s` since the start; beyond the end, the last point.
  Intent at(double t_s, const Grip& grip) const noexcept;
  double duration_s() const noexcept { return keys_.back().t_s; }
  /// When the suspects must be known, s.
  double rechecks_from_s() const noexcept { return rechecks_from_s_; }
  void recheck(const std::array<Suspect, kSuspects>& suspects) noexcept { suspects_ = suspects; }
  /// How far beyond the channel's end the hand aims in a tap, m.
  static constexpr double kTapBeyond_m = 0.003;

 private:
  struct Key {
    double t_s = 0.0;
    double depth_m = 0.0;
    double press = 0.0;
    Act act = Act::rest;  ///< of the segment that ends here, as are wall and look
    int wall = -1, look = -1;
    int suspect = -1;  ///< gives the wall, and the depth to which `depth_m` is added
  };
  struct Wave {
    double amplitude, frequency_rad_s, phase_rad;
  };
  void plan_palpation();
  void plan_recheck(int suspect);
  void plan_drilling();
  void add(double weight_s, Key key);
  Key resolved(Key key) const noexcept;
  double uniform() noexcept;
  double unsteadiness(int axis, double t_s) const noexcept;

  KnownTract channel_;
  double probe_length_m_, deepest_m_, shallowest_m_;
  std::uint64_t random_;
  std::vector<Key> keys_;
  double rechecks_from_s_ = 1e30;
  std::array<Suspect, kSuspects> suspects_{};
  std::array<std::array<Wave, 6>, 5> waves_;  // tremor and wander: three of position, two of tilt
};

}  // namespace tractus::devices
