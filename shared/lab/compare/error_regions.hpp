/// Where a model fails: a short list of readable regions, each with its share of the error.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/compare/samples.hpp"

namespace tractus::lab {

/// "depth > 0.02 m", "direction = out".
struct Condition {
  enum class Op { above, below, equals, not_equals };
  std::size_t feature = 0;  ///< of Samples::features
  Op op = Op::above;
  double bound = 0.0;    ///< for above and below
  std::size_t word = 0;  ///< for word and not_word
};

/// Moments that share a few conditions.
struct Region {
  std::vector<Condition> conditions;  ///< all hold; none means everywhere
  std::string text;                   ///< "direction = out and depth > 0.02 m"
  std::string words;                  ///< "direction = out and depth > 20 mm"
  double share_of_error = 0.0;        ///< of the sum of squared residuals
  double share_of_time = 0.0;
  double rmse = 0.0;
  std::vector<double> mean;  ///< mean residual, measured − simulated, by judged channel
};

struct ErrorRegions {
  std::vector<Region> regions;  ///< by error beyond what their time alone would bring
  /// How borders and figures were separated: "grown on 5 trials, filled from the other 5".
  std::string honest;
};

struct ErrorRegionOptions {
  int depth = 3;                ///< conditions in a row
  double leaf_share = 0.02;     ///< of the samples, at least
  std::size_t leaf_trials = 3;  ///< at least, where there are that many
  /// What a split must bring, on the trials it was grown on and on the others: see `find_error_regions`.
  double least_gain = 0.015;
  std::size_t most_regions = 6;
};

/// Grows a regression tree [Breiman1984] and reads its leaves.
///
/// A split is worth the nats by which it tells where the error is,
///
///     gain = Σ e_k ln(e_k / t_k)  +  Σ n_k |m_k|² / Σ r²          (leaves after − leaf before)
///
/// e_k and t_k the leaf's shares of squared residual and of time, m_k its mean residual (a vector
/// where several channels are judged): the first term finds where the error is large, the second
/// where it has one sign. Bounds are round numbers. Squared residuals count up to the 99.9 %
/// quantile, so that no single spike draws a border.
///
/// Honest [Athey2016, section 2]: borders come from one half of the trials, shares and means from
/// the other, and a split that the other does not confirm is taken back. A single trial is cut into
/// forty stretches of time instead. Which half a trial falls into is fixed by its number.
ErrorRegions find_error_regions(const Samples& samples, const ErrorRegionOptions& options = {});

/// The region that each sample of a trial lies in: an index into `regions`, −1 for none.
std::vector<std::int8_t> regions_by_sample(const Samples& samples, const TrialSamples& trial,
                                           const std::vector<Region>& regions);

/// One condition in SI ("depth > 0.02 m") or as people say it ("depth > 20 mm").
std::string text(const Condition& condition, const Samples& samples, bool for_people);

}  // namespace tractus::lab
