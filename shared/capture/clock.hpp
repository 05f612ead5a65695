/// Two clocks made one by taps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/taps.hpp"
#include "core/result.hpp"

namespace tractus::capture {

/// The same taps in the force and in the motion.
struct TapPair {
  std::vector<double> taps_s;  ///< of the motion's clock
  math::Vec3 inward;
  double offset_s = 0.0;  ///< t_force − t_motion, from all of the taps together
  double sd_s = 0.0;      ///< of that, by how far single taps disagree
  double together = 0.0;  ///< share of the force's variance in contact that the way explains
};

/// t_force = t_motion + offset_s + drift (t_motion − at_s)
struct ClockFit {
  double offset_s = 0.0, drift = 0.0, at_s = 0.0;
  double sd_s = 0.0;          ///< of the offset; 0 when it was stated
  std::vector<TapPair> runs;  ///< by time; empty when it was stated
  double force_time(double motion_s) const {
    return motion_s + offset_s + drift * (motion_s - at_s);
  }
  double motion_time(double force_s) const {
    return at_s + (force_s - offset_s - at_s) / (1.0 + drift);
  }
};

/// What is aligned: |force| (tared) and the tip's way, each by its own clock, strictly increasing.
struct Tapped {
  std::span<const double> force_t_s, force_N;
  std::span<const double> motion_t_s;
  std::span<const math::Vec3> tip_m;
};

/// Finds the taps in both and aligns them, as [Zoller2020] aligned force peaks with motion peaks:
///  1. runs of `count` peaks in either whose rhythm is the same within 25 ms;
///  2. the offset at which force and way go together best while in contact: least squares of
///     F(t + offset) = g (w(t) − w_k), one g for the run and one surface w_k for each tap, for what
///     goes beyond the surface is what hand and probe yield, and the force rises with it;
///  3. the offset that most runs agree on; of runs 5 s apart or more the drift, a line through
///     their offsets.
/// Departs from the source, which aligned peaks alone: at 100 Hz those are 10 ms wide.
/// Known limit: a surface that damps makes the force lead: 0.2 ms where it takes a few per cent off
/// the force on the way out, 3 ms where it takes most (SIMULATED, contacts of 60 ms). Errors:
/// bad_input, what was not found and what to do.
core::Result<ClockFit> align(const Tapped& tapped, int count);

}  // namespace tractus::capture
