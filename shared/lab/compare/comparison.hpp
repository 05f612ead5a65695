/// Model and measurements side by side: how large the error is, against what is noise, by channel,
/// by trial and by phase; how it is distributed and at which frequencies it lives.
#pragma once

#include <string>
#include <vector>

#include "lab/compare/error_regions.hpp"
#include "lab/compare/samples.hpp"

namespace tractus::lab {

/// Counts in equal bins.
struct Histogram {
  std::vector<double> edges;   ///< one more than counts
  std::vector<double> shares;  ///< of the samples; what lies outside the edges is in the end bins
};

/// Mean, spread and quantiles of one series.
struct Distribution {
  double mean = 0.0, sd = 0.0;
  double p05 = 0.0, p50 = 0.0, p95 = 0.0;
  Histogram histogram;
};

/// Power by bands of a third of an octave; Hann windows, half overlapping [Welch1967].
struct Spectrum {
  std::vector<double> frequency_Hz;                   ///< centres
  std::vector<double> measured, simulated, residual;  ///< one-sided density, unit² per Hz
};

/// One channel over the whole set.
struct ChannelComparison {
  std::string name;
  double rmse = 0.0;
  double r2 = 0.0;  ///< 1 − rmse² / variance of the measurement; NaN where it does not vary
  double noise_floor = 0.0;
  /// Share explained of what could be explained: (variance − rmse²) / (variance − floor²). 1 at the
  /// noise floor, 0 for a model that is no better than the mean, below 0 for a worse one; NaN where
  /// the measurement is noise alone.
  double explained = 0.0;
  double bias = 0.0;  ///< mean of measured − simulated
  Distribution measured, simulated, residual;
  Spectrum spectrum;
};

struct TrialComparison {
  std::string id;
  double rmse = 0.0;             ///< of what is judged
  std::vector<double> channels;  ///< rmse of each channel
  double duration_s = 0.0;
};

struct PhaseComparison {
  std::string phase;
  double rmse = 0.0;  ///< of its judged samples; NaN where there is none
  double share_of_error = 0.0, share_of_time = 0.0;
  double judged_share = 1.0;  ///< of its samples
};

struct JudgementShare {
  Judgement judgement = Judgement::judged;
  double share = 0.0;  ///< of all samples
};

struct Comparison {
  std::string judged_name, judged_unit;
  double rmse = 0.0, r2 = 0.0, noise_floor = 0.0, explained = 0.0;  ///< of what is judged
  std::vector<ChannelComparison> channels;
  std::vector<TrialComparison> trials;
  std::vector<PhaseComparison> phases;  ///< empty where the samples name none
  std::vector<JudgementShare> judgements;
  ErrorRegions error_regions;
};

/// Every judged sample counts alike, the others not at all; a phase is the feature named "phase". At least one trial with two
/// samples.
Comparison compare(const Samples& samples);

/// "93 % of the samples are judged (5 % at a border of layers, 2 % motion not known well enough are not)"; empty where
/// all are.
std::string judged_text(const Comparison& comparison);

}  // namespace tractus::lab
