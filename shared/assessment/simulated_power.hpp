/// `power --test mixed`: the power of a study with repeated trials, by simulation.
#pragma once

#include "assessment/method.hpp"

namespace tractus::assessment {

/// The options of the method 'power' that are of its test 'mixed' alone.
std::vector<Option> simulated_power_options();
/// Errors: as statistics::simulated_power and needed_surgeons.
core::Result<Findings> simulated_power(const Analysis& of);

}  // namespace tractus::assessment
