/// Intervals for a proportion of independent yes/no outcomes, and for the difference of two.
///
/// Wilson 1927 is the one to report; Clopper & Pearson 1934 where coverage must never fall short;
/// Newcombe 1998 (his method 10) for a difference. Outcomes of the same person are not independent:
/// these intervals are then too narrow.
#pragma once

#include "core/result.hpp"

namespace tractus::statistics {

struct Interval {
  double low = 0.0, high = 0.0;
};

/// A count of successes; bad_input unless whole, n ≥ 1 and 0 ≤ x ≤ n.
struct Proportion {
  double successes = 0.0, trials = 0.0;
  static core::Result<Proportion> make(double successes, double trials);
  double share() const { return successes / trials; }
};

/// (p + z²/2n ∓ z √(pq/n + z²/4n²)) / (1 + z²/n); with `continuity`, Newcombe's corrected form.
Interval wilson(const Proportion& of, double level = 0.95, bool continuity = false);
/// Exact: beta quantiles.
Interval clopper_pearson(const Proportion& of, double level = 0.95);
/// Wilson's centre with the plain width about it; may leave [0, 1].
Interval agresti_coull(const Proportion& of, double level = 0.95);
/// Beta(x + ½, n − x + ½) quantiles; 0 or 1 at the ends.
Interval jeffreys(const Proportion& of, double level = 0.95);
/// a − b, from the Wilson intervals of each.
Interval newcombe_difference(const Proportion& a, const Proportion& b, double level = 0.95);
/// Fisher's exact test that both proportions are equal: two-sided, by the probability of the table.
double fisher_exact(const Proportion& a, const Proportion& b);
/// Exact test that the chance of a success is `chance` (0 … 1), two-sided: the probability of all
/// counts that are no likelier than the observed one.
double binomial_test(const Proportion& of, double chance);

}  // namespace tractus::statistics
