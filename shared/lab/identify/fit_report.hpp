/// The insides that fit and diagnose share.
#pragma once

#include "lab/identify/fit.hpp"
#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// The given model's own numbers fitted; with a jacobian of its point.
Solution fit_base(const Residual& residual);

/// What is told of a solution; differentiates it anew.
Fit report(const Residual& residual, Solution& solution, bool held_out);

/// The held-out rmse alone, by the jacobian that the solution has.
double held_out_rmse(const Residual& residual, const Solution& solution);

}  // namespace tractus::lab
