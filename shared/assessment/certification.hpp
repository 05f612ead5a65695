/// How many trials it takes to say that somebody is competent, by LC-CUSUM.
///
/// A rule (threshold h, at most n trials) may certify when somebody who fails at the inadequate
/// rate is declared competent with a probability of at most `risk`, and somebody who fails at the
/// adequate rate with at least `power`; both exactly, by statistics/learning/cusum.hpp.
#pragma once

#include "statistics/learning/cusum.hpp"

namespace tractus::assessment {

struct Certification {
  statistics::Rates rates;
  double risk = 0.05, power = 0.80;
  int trials = 0;          ///< the fewest that can certify; 0: not within 400
  double threshold = 0.0;  ///< with this h
  /// Within n = 1 … 400 trials at that threshold.
  std::vector<double> passes_if_adequate, passes_if_inadequate;
};

/// Bisects h from 0.25 to 6 in steps of 0.05, n to 400. Known limit: sums move in steps, so a rule
/// a few trials shorter may exist at a lower h.
Certification certification(const statistics::Rates& rates, double risk = 0.05,
                            double power = 0.80);

/// The same with the usual risk and power, computed once in each thread.
const Certification& usual_certification(const statistics::Rates& rates);

}  // namespace tractus::assessment
