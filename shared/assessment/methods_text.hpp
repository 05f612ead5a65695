/// The sentences of a report, every number in them taken from the result.
#pragma once

#include "assessment/analyse.hpp"

namespace tractus::assessment {

/// What was done: sample, exclusions, methods, correction, level, lock.
std::vector<std::string> methods_sentences(const Plan& plan, const core::Json& result);
/// What came out: one per test of a family, then one per analysis that could not be done.
std::vector<std::string> results_sentences(const core::Json& result);

}  // namespace tractus::assessment
