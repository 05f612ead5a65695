/// Two clocks made one by five taps against a solid surface.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace capture {

/// A run of taps in one recording: when each was hardest, or deepest.
struct TapRun {
  std::vector<double> at_s;
  std::vector<double> height;  ///< N, or m
};

/// Runs of `count` peaks of |force| over time: each at least three times as high as what lies
/// between and half as high as the highest of its run, 0.12 … 1.5 s apart. All such runs, by time:
/// short, sharp peaks elsewhere may look like taps; the other recording tells.
/// @param t_s  strictly increasing @param force_N  its norm, tared
std::vector<TapRun> force_taps(std::span<const double> t_s, std::span<const double> force_N,
                               int count);

/// The same in the way of the tip: `count` turns back after an approach, all in one direction. That
/// direction is found: the principal axis of the tip's motion within the run, pointing where it
/// turns sharply (the surface), for a hand turns softly where nothing is.
std::vector<TapRun> motion_taps(std::span<const double> t_s, std::span<const math::Vec3> tip_m,
                                int count);

/// How the force's clock stands to the motion's: t_force = t_motion + offset_s.
struct ClockOffset {
  double offset_s = 0.0;
  double sd_s = 0.0;                ///< of the mean over the taps: how far they disagree
  double rhythm_s = 0.0;            ///< root mean square of the intervals' mismatch
  std::vector<double> taps_s = {};  ///< of the motion's clock
};

/// The pair of runs whose rhythm is the same, as [Zoller2020] aligned force peaks and motion peaks.
/// Errors: bad_input: no run in either, or the best pair's intervals are more than 25 ms apart, or
/// another pair fits as well at another offset.
core::Result<ClockOffset> align(std::span<const TapRun> force, std::span<const TapRun> motion);

}  // namespace capture
