/// The insides that fit and diagnose share.
#pragma once

#include "lab/identify/fit.hpp"
#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// The given model's own numbers fitted, and those of effects if there are any, all from their starts; with a jacobian of its
/// point.
Solution fit_base(const Residual& residual, const Structure& structure = {});

/// What is told of a solution; differentiates it anew.
Fit report(const Residual& residual, Solution& solution, bool held_out);

/// Is every effect of a structure told from none by a strength on which the trials agree? By Student's t over the trials,
/// with the chance ValidationSettings::found_by_chance shared by all effects of the catalogue [Dunn1961]. True of an effect
/// that is free in each trial.
bool told_from_zero(const Residual& residual, const Solution& solution);

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
