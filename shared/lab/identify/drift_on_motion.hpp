/// Checks that a fitted sensor drift is not explained by the motion before it.
#pragma once

#include <string_view>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// The trend that `trend_effect` (free per trial) takes out of a recording against the trends of what the motion does and
/// leaves behind. Of a force along the way these are slow memories of the speed, the position and its square, and the
/// direction of the last motion; of a force in space, slow memories of the contact force, as of bone that creeps. Returned
/// is the share of the fitted trends' variance, over all trials and components together, that these explain by numbers
/// common to all, adjusted for how many they are (adjusted R²). A sensor drifts by itself, so of a drift it is about 0; of a
/// slow law that no effect of the structure holds it is most.
/// @return 0 … 1; 0 where the states lack what is held against the trend, or the structure has no such effect.
double drift_r2_on_motion(const Residual& residual, const Solution& at,
                          std::string_view trend_effect);

}  // namespace tractus::lab
