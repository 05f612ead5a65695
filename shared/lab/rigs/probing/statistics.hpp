/// What recordings of the probing rig show, for the numbers that the search for an effect begins
/// with.
#pragma once

#include <Eigen/Core>
#include <span>

#include "effects/probing_effect.hpp"
#include "lab/rigs/probing/recording.hpp"

namespace tractus::lab {

/// @param residual  whitened, thinned, of all trials one under another.
effects::ProbingStatistics statistics_of(std::span<const ProbingRecording> trials,
                                         const Eigen::VectorXd& residual);

}  // namespace tractus::lab
