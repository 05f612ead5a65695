/// Samples at which a sensor stood at the end of its range.
#pragma once

#include <span>
#include <vector>

namespace tractus::lab {

/// Of each sample, whether it is one of a run of the largest or of the least value that is longer than the noise would
/// leave alike: the chance of one such run in the whole channel, by how often neighbours are alike elsewhere, is below
/// 0.001. A channel without visible noise is never called saturated, for there it may just have been held.
/// @param noise_sd  of one sample, in the channel's unit, as its differences say; 0: not visible.
std::vector<char> saturated(std::span<const double> y, double noise_sd);

}  // namespace tractus::lab
