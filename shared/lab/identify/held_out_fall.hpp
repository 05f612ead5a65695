/// Whether one structure predicts materially better than another: everywhere, or where the two differ.
#pragma once

#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// How the unweighted error of the primary channel falls from one structure to another where the two differ most, in trials
/// that neither was fitted to, over samples that both judge. Noise of free air does not hide there what an effect does in
/// contact alone.
struct HeldOutFall {
  double share = 0.0;   ///< of the rmse
  double trials = 0.0;  ///< share of the trials with such samples in which it falls
};
HeldOutFall held_out_fall_where_different(const Residual& residual, const Solution& smaller,
                                          const Solution& larger);

/// Is the larger structure's held-out error lower by more than small flaws of motion and sensor make? By
/// SelectionSettings::least_fall of all samples; or by any of all, if by SelectionSettings::least_fall_there where the two
/// differ, and that in nearly all trials. @param rmse_smaller, rmse_larger  held-out, without weights.
bool predicts_better(const Residual& residual, const Solution& smaller, double rmse_smaller,
                     const Solution& larger, double rmse_larger);

/// The least of the squares that count as large: those from it on hold SelectionSettings::most_of_difference of the sum, and
/// are SelectionSettings::least_region of all at least. 0 of nothing.
double large_from(std::vector<double> squares);

}  // namespace tractus::lab
