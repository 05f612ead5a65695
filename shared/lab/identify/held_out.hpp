/// What fits leave of trials that they did not see, and how much less one structure leaves than another.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// What is held out at once: a trial or, of few trials, a stretch of one.
struct Fold {
  int trial;
  double from_s, to_s;        ///< of the trial's time at the full rate
  Eigen::Index first, count;  ///< of the residuals that a fit sees
};
std::vector<Fold> folds_of(const Residual& residual);

/// The normal equations of a whole solution, by which its folds are left out.
class LeftOut {
 public:
  LeftOut(const Residual& residual, const Solution& at);
  /// Values without a fold: one step of Newton's from the whole's, in the directions that the rest
  /// informs too. (A number that one trial alone informs, as a layer that only it entered, cannot be
  /// predicted from the others; it stays. So does the place of a border: the loss has no slope in it,
  /// and every trial that crosses it tells it alike.)
  std::vector<double> values(const Fold& fold) const;

 private:
  const Solution& at_;
  Eigen::VectorXd weights_;
  Gram whole_;
};

/// Sums of squares of a trial's judged samples, without weights.
struct Squares {
  double judged = 0.0, count = 0.0;  ///< of the primary channel; samples
  std::vector<double> channels;
};
/// Between two times of a trial.
Squares squares_between(const ResidualModel& model, const Structure& structure,
                        std::span<const double> values, int trial, double from_s, double to_s);
/// NaN of nothing: an error that nobody could judge is not 0.
double root_mean(double sum, double count);

/// The held-out rmse alone, by the jacobian that the solution has.
double held_out_rmse(const Residual& residual, const Solution& solution);

/// Of each fold the mean square of the primary's judged samples, without weights, that a fit of the others leaves, by the
/// jacobian that the solution has when it is first asked; NaN where nothing is judged.
const Eigen::VectorXd& held_out_squares(const Residual& residual, const Solution& solution);

/// Of each fold (trial, or stretch of one) what a fit of the others leaves there: the mean of Huber's loss at `scale` over what
/// the structure judges, by the jacobian that the solution has. What is free in each trial is fitted to the trial's other
/// stretches.
Eigen::VectorXd held_out_losses(const Residual& residual, const Solution& solution, double scale);

}  // namespace tractus::lab
