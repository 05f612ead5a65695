/// Whether what a model leaves can be predicted from what was recorded, and from which signals.
#pragma once

#include <string>
#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// How well functions of the recorded signals predict the primary channel's error in trials that they were not fitted
/// to. Noise, of whatever colour, cannot be predicted so; physics that is missing can, unless its cause was not recorded.
struct ResidualDependence {
  /// Share of the error's mean square at the full rate that a sum of functions of the signals, of pairs of them and of
  /// their memory takes away in held-out trials, 0 … 1.
  double predictable = 0.0;
  /// Share of the trials in which it takes away any.
  double trials_better = 0.0;
  /// The greatest such share by a function of one signal alone.
  double explained = 0.0;
  std::string words;  ///< "depth (61 %), velocity (12 %)"; says so if no signal alone does
};

/// Functions are sums of hats over the quantiles of a signal, with a ridge [Hastie2009, eq. 3.41].
ResidualDependence residual_dependence(const Residual& residual, const Solution& solution);

}  // namespace tractus::lab
