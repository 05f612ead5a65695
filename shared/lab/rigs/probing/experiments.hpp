/// Start values for the search of an effect on the probing rig, and the recording that separates two
/// effects.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/rigs/probing/recording.hpp"

namespace tractus::lab {

/// Starts for effects whose numbers of shape the recording itself suggests: speeds that occur,
/// times and depths that fit in, periods that the residual shows. Empty: no suggestion.
/// @param residual  whitened, thinned, of all trials one under another.
std::vector<std::vector<double>> probing_starts(std::string_view effect,
                                                std::span<const ProbingRecording> trials,
                                                const Eigen::VectorXd& residual);

/// The recording on this rig that separates two effects, or shows one (`b` empty).
std::string probing_recording(std::string_view a, std::string_view b);

}  // namespace tractus::lab
