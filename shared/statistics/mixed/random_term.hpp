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

/// What an estimate says of one random term.
struct RandomPart {
  std::string group;
  std::vector<std::string> names;   ///< of the effects
  Matrix covariance;                ///< Σ_t [effect][effect]
  std::vector<std::string> levels;  ///< in order of first appearance
  Matrix effects;         ///< predictions: conditional modes, which a linear model's BLUPs are too,
                          ///< [level][effect]
  bool singular = false;  ///< Σ_t has no full rank
};

/// Errors: bad_input for a grouping of one level or with an effect for each of `outcomes` (rows, or
/// answers where rows are counts), a slope's column of zeros, more effects in all than a machine
/// holds.
core::Result<void> check_terms(const std::vector<RandomTerm>& terms, Eigen::Index rows,
                               double outcomes);

}  // namespace tractus::statistics
