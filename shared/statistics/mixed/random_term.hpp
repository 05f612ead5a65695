/// A random term of a mixed model, as the caller gives it.
#pragma once

#include <string>
#include <vector>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

/// What varies between the levels of one grouping: (1 + trial | surgeon).
struct RandomTerm {
  std::string group;                ///< "surgeon"
  std::vector<std::string> labels;  ///< the level of each observation
  Matrix columns;  ///< [observation][effect]: ones for an intercept, a slope's values
  std::vector<std::string> names;  ///< of the effects
};

/// Errors: bad_input for a grouping of one level or with an effect for each observation, a slope's
/// column of zeros, more effects in all than a machine holds.
core::Result<void> check_terms(const std::vector<RandomTerm>& terms, Eigen::Index rows);

}  // namespace tractus::statistics
