/// Several tests of one question: p-values adjusted so that each may be held against the one α.
#pragma once

#include <vector>

namespace tractus::statistics {

enum class Adjustment {
  bonferroni,          ///< p m
  holm,                ///< step-down; controls the chance of any false positive (Holm 1979)
  hochberg,            ///< step-up; the same, for independent or positively dependent tests
  hommel,              ///< closed Simes tests; the same, never weaker than Hochberg (Hommel 1988)
  benjamini_hochberg,  ///< controls the expected share of false positives
  benjamini_yekutieli  ///< the same under any dependence
};

/// Adjusted p in the order given, capped at 1, never falling where p rises. Each p in [0, 1].
std::vector<double> adjusted(const std::vector<double>& p, Adjustment how);

}  // namespace tractus::statistics
