/// From a problem's residuals and states to samples that a comparison can read.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/compare/samples.hpp"
#include "lab/identify/problem.hpp"
#include "trial/measurement_set.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab {

/// What the sensors said: kept beside a problem, which takes its measurements over.
struct Recorded {
  struct Trial {
    std::string id;
    std::vector<double> t_s;
    std::vector<std::vector<double>> values;  // [channel][sample]
  };
  std::vector<std::string> channels;  ///< "fz_N", "tz_Nm"; those that were recorded
  std::vector<Trial> trials;
};
Recorded recorded(const trial::ProbingSet& set);
Recorded recorded(const trial::PalpationSet& set);

/// Samples of a problem under one structure with its values: measured, simulated = measured −
/// residual, and features made from the problem's states.
///
/// What is judged is the problem's primary channel; where that is the norm of a vector's error
/// ("force_N"), its three components. Features are the states by their names without the unit, and
/// for probing "direction" (in, out, still), "phase" (see phases.hpp) and "time since reversal",
/// for palpation "phase". Speeds are without sign.
Samples samples_of(const Problem& problem, const Structure& structure,
                   std::span<const double> values, const Recorded& recorded);

/// The same under the values at which a fit of the structure would start: the model as it is given.
Samples samples_as_given(const Problem& problem, const Recorded& recorded);

}  // namespace tractus::lab
