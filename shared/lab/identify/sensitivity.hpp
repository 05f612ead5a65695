/// How small an effect that is not named would have been seen.
#pragma once

#include <string_view>
#include <vector>

#include "lab/identify/diagnosis.hpp"
#include "lab/identify/effect_screen.hpp"

namespace tractus::lab {

/// For each strength of an effect the least value at which it would have been named beside the fitted structure, at the
/// shape (of those the search begins with) that is in the middle by how well it shows: what it adds, less what the fitted numbers can imitate,
/// must pass the same thresholds as an effect that is found (clear gain of the loss, material fall of the error, more
/// evidence than the number of structures costs). Empty for what is free per trial or never excited.
/// @param at      the final structure, with a jacobian of its own point
/// @param rmse    its error, unweighted, on the primary channel's judged samples
/// @param screen  of the effect on that structure
std::vector<DetectionLimit> detection_limits(const Residual& residual, const Solution& at,
                                             double rmse, const LinearScreen& screen,
                                             std::string_view effect);

}  // namespace tractus::lab
