/// Whether what a model leaves follows a law of physics that the model does not have.
#pragma once

#include <string>
#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// How well laws with few numbers (ForceLaws) predict the primary channel's error vectors in trials to which they were not
/// fitted. A law says how a force is directed, so that its few numbers hold for all components at once; functions of one
/// signal (residual_dependence.hpp) need dozens for each, and see only what is large.
struct LawDependence {
  /// Share of the judged samples' squares, each over its own variance, that laws take away beyond the first, 0 … 1. 0 where
  /// the rig has no laws, or of fewer than four trials.
  double share = 0.0;
  std::vector<std::string> laws;  ///< in the order in which they take away most
};

/// Products of all laws' terms in their order and of the error (last) with each other, over the judged samples of a trial.
/// @param left  channels 1 to 3 are the error's components. @param without_trends  a trend of each component is free in
/// the trial, so that none counts, of the laws as of the error.
Eigen::MatrixXd law_products(const Residuals& left, const ForceLaws& laws, bool without_trends);

/// Forward selection, each trial predicted by the numbers that the others have.
/// @param products  of each trial, four at least. @param laws  of any of them; only names and numbers of terms are read.
LawDependence law_dependence(const std::vector<Eigen::MatrixXd>& products, const ForceLaws& laws);
LawDependence law_dependence(const Residual& residual, const Solution& solution);

}  // namespace tractus::lab
