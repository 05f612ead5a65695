/// How far the raters of the same trials agree.
///
/// Two-way random effects, absolute agreement: ICC(2,1) of one rater, ICC(2,k) of the mean of all k
/// [Shrout1979], with 95 % intervals [McGraw1996]. Of an item and two raters also Cohen's kappa, its
/// disagreements weighted by their squares [Cohen1968]. Every rater must have rated every trial.
#pragma once

#include <optional>
#include <string>

#include "statistics/distributions/proportions.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::assessment {

struct RatingAgreement {
  std::optional<double> single;      ///< ICC(2,1)
  std::optional<double> mean;        ///< ICC(2,k)
  statistics::Interval single_95;    ///< where there is `single`
  statistics::Interval mean_95;      ///< where there is `mean`
  std::optional<double> kappa = {};  ///< of two raters and an item alone
  std::string note = {};             ///< why there is no ICC; empty if there is
};

/// A scale of whole points.
struct ScoreScale {
  int low = 1, high = 5;
};

/// @param scores  [trial][rater], two columns or more
/// @param scale   of an item; nothing for sums of items, which have no kappa
RatingAgreement rating_agreement(const statistics::Matrix& scores,
                                 const std::optional<ScoreScale>& scale);

/// Differences of two raters, first less second: their mean, and the limits within which 95 % of
/// them lie, mean ± 1.96 SD [Bland1986].
struct DifferenceLimits {
  double mean = 0.0, low = 0.0, high = 0.0;
};
/// Nothing for other than two raters, or fewer than two trials.
std::optional<DifferenceLimits> difference_limits(const statistics::Matrix& scores);

}  // namespace tractus::assessment
