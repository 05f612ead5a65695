/// The stretches of a probing trial that its scores are made of.
#pragma once

#include <span>

#include "metrics/metric.hpp"

namespace tractus::metrics {

/// From the first motion that is let through (the probe turns faster than 10 °/s, so that the mode
/// is no longer `holding`) to the last sample before the probe stop, or to the last one. Samples
/// without a fresh reading are part of it: their numbers are the last good ones. Empty when the
/// probe never turned.
std::span<const trial::ProbingSample> probing_motion(const trial::Trial& trial);

/// The first stretch of samples whose mode is `breach`, from its first to its last sample. Holding
/// still in soft tissue is part of it, as long as the bone behind has not begun. Empty when there
/// was none.
std::span<const trial::ProbingSample> first_breach(const trial::Trial& trial);
/// How many times the probe went through a wall: the mode became `breach` while it went inward.
/// (Resting against the bone behind a breach, the stage goes to and fro across that border by
/// single steps of its motor: that is no new breach.)
std::size_t breach_count(const trial::Trial& trial);

/// Mean and variance (n − 1) in two passes, and extremes.
struct Spread {
  std::size_t count = 0;
  double mean = 0.0, variance = 0.0, least = 0.0, most = 0.0;
};
Spread spread_of(std::span<const trial::ProbingSample> samples,
                 double (*value)(const trial::ProbingSample&));
inline double push_N(const trial::ProbingSample& s) { return double(s.fz_N); }
inline double speed_m_s(const trial::ProbingSample& s) { return double(s.speed_m_s); }

/// A score of a section: no value, and why, when the section has fewer than `least` samples.
Score score_of_motion(const Subject& subject, std::size_t least,
                      double (*score)(std::span<const trial::ProbingSample>));
Score score_of_breach(const Subject& subject, std::size_t least,
                      double (*score)(std::span<const trial::ProbingSample>));

/// Pauses within the motion: the speed into the bone, averaged over 0.1 s round each sample (one
/// period of 10 Hz tremor, which would hide a pause), is below kPause_m_s for at least kPause_s.
/// Rest at either end is none. Thresholds are our own: probing goes at some 5 mm/s.
inline constexpr double kPause_m_s = 0.001, kPause_s = 0.1, kPauseSmooth_s = 0.1;
struct Pauses {
  int count = 0;
  double total_s = 0.0;
};
Pauses pauses_of(std::span<const trial::ProbingSample> motion, double rate_Hz);

}  // namespace tractus::metrics
