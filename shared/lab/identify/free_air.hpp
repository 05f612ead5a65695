/// Checks that an effect which also acts where nothing is touched is found there.
#pragma once

#include <optional>
#include <string>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// How much of a fitted effect the samples in free air show: the factor s on what the effect changes there, by least squares
/// of the residual without it, Σ r·d / Σ d·d. 1 where it acts in air as it was fitted, 0 where nothing of it is seen. In
/// contact the pose's errors move the force by stiffness times the error, which follows the acceleration as a mass at the
/// tip would; in air they move nothing.
/// @param with  a solution that has the effect. @param without  the same structure without it, fitted.
/// @param least_share  of the mean square of what the effect changes, in free air: below, it acts there too little to be asked.
/// 0 of a sensor's trend, which does not know what the probe touches.
/// @return nothing where the rig has no free air, or the effect acts there too little to be seen
std::optional<double> share_in_free_air(const Residual& residual, const Solution& with,
                                        const Solution& without, double least_share);

}  // namespace tractus::lab
