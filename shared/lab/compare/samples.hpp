/// What a comparison looks at: recordings and a model's answer to them, sample by sample, and what
/// a person can say about each moment (how deep, which way, how fast).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/identify/problem.hpp"

namespace tractus::lab {

/// Something readable about a moment: a number with a unit, or one of a few words.
struct Feature {
  std::string name;                ///< "depth"
  std::string unit;                ///< SI, "m"; empty for words and for counts
  std::vector<std::string> words;  ///< a feature with words holds their indices
};

/// One trial. Channels are in the order of Samples::channels, features in that of
/// Samples::features. Features are kept for every `stride`-th sample, to bound memory on long
/// recordings.
struct TrialSamples {
  std::string id;
  std::vector<double> t_s;
  std::vector<std::vector<double>> measured, simulated;  // [channel][sample]
  std::size_t stride = 1;
  std::vector<std::vector<float>> features;  // [feature][row]; row k is sample k · stride
  std::vector<Judgement> judgement = {};     ///< one per sample; empty where every sample counts

  std::size_t rows() const { return (t_s.size() + stride - 1) / stride; }
  bool is_judged(std::size_t sample) const {
    return judgement.empty() || judgement[sample] == Judgement::judged;
  }
  double residual(std::size_t channel, std::size_t sample) const {
    return measured[channel][sample] - simulated[channel][sample];
  }
};

/// A set of measurements beside the answers of one model.
struct Samples {
  std::vector<Channel> channels;
  /// What is judged: the channels whose residuals, squared and summed, make the headline error.
  /// One for probing, the three of the force for palpation.
  std::vector<std::size_t> judged;
  std::string judged_name;  ///< "fz_N", "force_N"
  std::string judged_unit;  ///< "N"
  std::vector<Feature> features;
  std::vector<TrialSamples> trials;

  /// Index of a feature by name; features.size() if there is none.
  std::size_t feature(const std::string& name) const;
  /// Root of the summed squares of the judged channels' floors.
  double judged_floor() const;
  /// Squared residual of what is judged.
  double squared(const TrialSamples& trial, std::size_t sample) const;
};

}  // namespace tractus::lab
