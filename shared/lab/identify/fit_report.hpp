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

}  // namespace tractus::lab
