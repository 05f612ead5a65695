/// A recorded motion made smooth and differentiated, with what is not known of it.
#pragma once

#include <span>
#include <vector>

namespace tractus::lab {

/// A quantile of the mean square of 16 third differences of white noise, and what it is of the mean, by 4e6 simulated
/// samples.
struct NoiseQuantile {
  double share, of_mean;
};
/// A low one: kinks are in the upper ones.
inline constexpr NoiseQuantile kNoiseQuantile{0.3, 0.6732};
/// Of the quietest tenth: for what is not noise alone for most of the time.
inline constexpr NoiseQuantile kQuietestQuantile{0.1, 0.4298};

/// A signal with its first two derivatives, one entry per sample, and their standard errors.
struct Smoothed {
  std::vector<double> value, rate, acceleration;
  std::vector<double> value_sd, rate_sd, acceleration_sd;
  double noise_sd = 0.0;  ///< of one recorded sample, as estimated or stated
};

/// Between two samples the motion's rate and acceleration may jump, as where a probe enters another layer.
struct Break {
  std::size_t sample;  ///< the one after it, ≥ 1
  double share = 0.5;  ///< of the interval that is over when it happens, 0 … 1
};

/// Standard deviation of the white noise on a smooth signal: from third differences, which a
/// quadratic does not pass; a low quantile over short stretches, so that kinks and impacts do not count,
/// not even one every twentieth of a second. Quantisation counts as noise. Fewer than 8 samples: 0.
double noise_sd(std::span<const double> y, NoiseQuantile of = kNoiseQuantile);

/// The same where the motion itself may be fast against the samples: by fifth, seventh and ninth differences, as long as each
/// gives much less than the one before, which white noise does not.
double noise_sd_on_fast_motion(std::span<const double> y);

/// How much less a sample that repeats its neighbours says than one of its own, as the variance of
/// its noise over that of others: rounding hides in all of them what it hides in one. 1 where
/// neighbours differ.
std::vector<double> rounding_variance(std::span<const double> y);

/// Fixed-interval Kalman smoothing (Rauch–Tung–Striebel in the adjoint form of [deJong1989]) of a
/// value whose third derivative is white noise, which for evenly spaced samples is the quintic
/// smoothing spline: gain 1/(1 + (f/f0)⁶), no phase. The cut-off f0 is not given but estimated
/// along the signal: of a bank of cut-offs, at each moment the one that best predicts the samples
/// left out round it. Samples that repeat one rounded value count as one. So a pause is smoothed
/// much and a kink (a border of layers, a stop) little, and the standard errors say so. Time stamps
/// need not be even. At a break rate and acceleration are free to jump by what SmoothingSettings says, the value is not.
///
/// @param t_s  strictly increasing. @param y  as many. @param noise_sd  of one sample, > 0.
Smoothed smooth(std::span<const double> t_s, std::span<const double> y, double noise_sd,
                const std::vector<Break>& breaks = {});

}  // namespace tractus::lab
