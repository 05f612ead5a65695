/// Successes out of trials in a table: rows of 0 and 1, or rows of counts.
#pragma once

#include "assessment/method.hpp"
#include "statistics/distributions/proportions.hpp"

namespace tractus::assessment {

struct Counted {
  std::string name;  ///< the group's label; "all" where the formula has none
  statistics::Proportion of;
};

/// `y ~ 1`, `y ~ group` (y of 0 and 1) or `successes/trials ~ …`, summed by group. Errors:
/// bad_input naming FILE:LINE of a row that is no count, or a formula of another shape.
core::Result<std::vector<Counted>> counted_groups(const Analysis& of);

/// A column of 0 and 1 (also true/false, yes/no) as such. Errors: bad_input naming FILE:LINE.
core::Result<std::vector<bool>> yes_no(const Table& table, const std::string& column);

}  // namespace tractus::assessment
