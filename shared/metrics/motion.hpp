/// How smoothly and how far a point moved: measures of the literature on evenly sampled motion.
///
/// Definitions and their departures from the sources stand at each function. Values are per sample,
/// `rate_Hz` apart; SI.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "math/geometry.hpp"

namespace tractus::metrics {

/// Spectral arc length of a speed profile [Balasubramanian2015]: the length of the magnitude
/// spectrum, normalised to its maximum, from the first to the last bin of at least 5 % up to 10 Hz;
/// zero-padded to 2^(⌈log₂ N⌉ + 4). Nearer to 0 is smoother; a minimum-jerk movement has −1.41.
/// Nothing for fewer than 3 samples or a point at rest.
std::optional<double> spectral_arc_length(std::span<const double> speed, double rate_Hz);

/// Log dimensionless jerk of a speed profile [Balasubramanian2015, as in its published program]:
/// −ln( T³/v_peak² Σ (Δ²v/dt²)² dt ), T = N dt. A minimum-jerk movement has −5.3.
std::optional<double> log_dimensionless_jerk(std::span<const double> speed, double rate_Hz);

/// Movement units: local maxima of at least `floor` (v_i > v_i−1, v_i ≥ v_i+1, beyond rounding of
/// 1e-9 of the speed).
int speed_peaks(std::span<const double> speed, double floor);

/// Power of a signal between two frequencies: Welch's density (periodic Hann window of 256 samples,
/// half overlapping, each segment's mean removed), summed over the bins within [low, high]. Nothing
/// for fewer than 256 samples.
std::optional<double> band_power(std::span<const double> values, double rate_Hz, double low_Hz,
                                 double high_Hz);

/// A point's motion, differentiated by Savitzky–Golay fits: velocity by 21 samples of order 3, jerk
/// by 41 of order 5.
struct Kinematics {
  std::vector<double> speed_m_s;
  double path_m = 0.0;       ///< trapezoid of the speed
  double straight_m = 0.0;   ///< first to last point
  double jerk2_m2_s5 = 0.0;  ///< Σ ‖jerk‖² dt
  double duration_s = 0.0;   ///< (N − 1) dt
  /// √( T⁵ / (2 PL²) ∫ ‖jerk‖² dt ) [Cotin2002]: larger is less smooth.
  double motion_smoothness() const;
};
/// Nothing for fewer than 41 points.
std::optional<Kinematics> kinematics(std::span<const math::Vec3> points_m, double dt_s);

/// ∫ y dx by the trapezoid rule.
double integral(std::span<const double> x, std::span<const double> y);

}  // namespace tractus::metrics
