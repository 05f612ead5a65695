/// The smoother's numbers; see settings.hpp for what the last word of each comment says.
#pragma once

#include <cstddef>

namespace tractus::lab {

/// Cut-off frequencies that the smoother tries for a motion, and how it judges them.
struct SmoothingSettings {
  /// How much the rate may jump at a break, standard deviation: a massless probe that enters bone. Prior.
  double jump_rate_m_s = 0.02;
  /// And the acceleration. Prior.
  double jump_acceleration_m_s2 = 0.3;
  /// The lowest cut-off that is tried. Tuned.
  double lowest_cutoff_Hz = 0.8;
  /// The highest that is always tried; hands and drives move below it. Physical.
  double highest_cutoff_Hz = 200.0;
  /// The highest where the motion is faster, in samples per second. Bound.
  double highest_cutoff_of_rate = 1.0;
  /// A higher cut-off is tried where the last lowered what is left out to this share. Tuned.
  double faster_motion_fall = 0.8;
  /// Higher differences tell noise where each is below this share of the one before. Tuned.
  double fast_motion_fall = 0.5;
  /// From one cut-off to the next. Numeric.
  double cutoff_ratio = 1.35;
  /// A cut-off is judged over stretches of at least this length: the shorter sees kinks. Tuned.
  double reach_s = 0.02;
  /// And of at least so many samples. Tuned.
  double reach_samples = 10.0;
  /// The longer stretch, in periods of the cut-off: it sees a steady bias. Tuned.
  double reach_periods = 0.5;
  /// A stretch whose mean square exceeds its expected value by more than so many standard errors is
  /// too smooth. Tuned.
  double significant_errors = 4.0;
  /// What a single stretch adds to the choice for the whole at most, in squares of the noise. Tuned.
  double greatest_misfit = 1.5;
  /// Least noise, in largest steps: below, the filter's sums lose all digits. Numeric.
  double least_noise = 1e-5;
  /// Long recordings are smoothed in stretches of so many samples. Bound.
  std::size_t stretch_samples = 1u << 17;
  /// By which neighbouring stretches overlap. Bound.
  std::size_t overlap_samples = 1u << 11;
};

}  // namespace tractus::lab
