/// Taps against a solid surface, found in a force and in a motion.
#pragma once

#include <span>
#include <vector>

#include "math/geometry.hpp"

namespace tractus::capture {

/// A run of taps in one recording: when each was hardest, or deepest.
struct TapRun {
  std::vector<double> at_s;
  std::vector<double> height;  ///< N, or m
  /// Of a motion: into the surface, a unit vector.
  math::Vec3 inward = math::Vec3::Zero();
};

/// Runs of `count` peaks of |force| over time: each at least three times as high as what lies
/// between and half as high as the highest of its run, 0.12 … 1.5 s apart. All such runs, by time:
/// short, sharp peaks elsewhere may look like taps; the other recording tells.
/// @param t_s  strictly increasing @param force_N  its norm, tared
std::vector<TapRun> force_taps(std::span<const double> t_s, std::span<const double> force_N,
                               int count);

/// The same in the way of the tip: `count` turns back after an approach of 2 mm or more, all in one
/// direction, which is the axis of most motion within the run. A tip that is waved to and fro in
/// the air looks the same: the force tells.
std::vector<TapRun> motion_taps(std::span<const double> t_s, std::span<const math::Vec3> tip_m,
                                int count);

}  // namespace tractus::capture
