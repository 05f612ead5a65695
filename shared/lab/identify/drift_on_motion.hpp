/// Checks that a fitted sensor drift is not explained by the motion before it.
#pragma once

#include <string_view>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// The trend that `trend_effect` (free per trial) takes out of a probing recording against what the
/// motion before has left behind: share of the trend's variance, over all trials together, that a
/// few slow memories of the speed explain. A sensor drifts by itself, so of a drift this is the
/// little that a handful of numbers explains by chance; of a slow relaxation that no effect of the
/// structure holds it is most of it.
/// @return 0 … 1; 0 where the recording has no speed or the structure no such effect.
double drift_r2_on_motion(const Residual& residual, const Solution& at,
                          std::string_view trend_effect);

}  // namespace tractus::lab
