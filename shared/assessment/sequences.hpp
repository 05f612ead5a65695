/// Failures in the order of trials, one sequence per person: what cumulative sums are made of.
#pragma once

#include "assessment/report.hpp"

namespace tractus::assessment {

struct Sequence {
  std::string name;            ///< "all" without (1|person)
  std::vector<bool> failures;  ///< in order
};

/// The response as failures ("response" of the method's options says what 1 means), by the column
/// `order`. Errors: bad_input for a response that is not yes or no, an order that is not a number,
/// and the same place twice.
core::Result<std::vector<Sequence>> sequences_of(const Analysis& of, const std::string& order);

}  // namespace tractus::assessment
