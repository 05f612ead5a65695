/// The random terms of a formula, for the mixed models that take any: what they need of a table, and
/// what their reports say of the terms.
#pragma once

#include "assessment/method.hpp"
#include "statistics/mixed/random_term.hpp"

namespace tractus::assessment {

/// Errors: bad_input for a slope that is no column of numbers.
core::Result<std::vector<statistics::RandomTerm>> random_terms(const Analysis& of);

/// Adds "random_effects", one row per variance and, of a term with slopes, per correlation; and
/// "group_effects", the predictions for each level of a grouping with few.
void add_random_effects(const std::vector<statistics::RandomPart>& parts, core::Json& out);

/// Sentences on singular terms, few levels, and a minimum that was not reached.
core::Json random_notes(const std::vector<statistics::RandomPart>& parts, bool converged);

}  // namespace tractus::assessment
