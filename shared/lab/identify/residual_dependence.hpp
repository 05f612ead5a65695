/// On which recorded signals an unexplained residual depends.
#pragma once

#include <string>
#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

struct ResidualDependence {
  /// Share of the residual that a smooth function of the recorded signals predicts in trials (or
  /// stretches) that it did not see, 0 … 1.
  double explained = 0.0;
  std::string words;  ///< "depth (61 %), and less speed (12 %)"; says so if nothing recorded does
};

/// For each state of the recording alone: a piecewise-linear function of it, fitted to the
/// primary's error on some trials and judged on the others. The states are named by how much they
/// predict.
ResidualDependence residual_dependence(const Residual& residual, const Solution& solution);

}  // namespace tractus::lab
