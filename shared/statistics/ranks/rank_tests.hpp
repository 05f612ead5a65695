/// Tests on ranks: nothing assumed about distributions. Ties get their mean rank throughout.
#pragma once

#include <optional>

#include "statistics/anova/anova.hpp"

namespace tractus::statistics {

/// 1 … n, ties their mean.
Vector ranks(const Vector& values);

struct KruskalWallis {
  double h = 0.0, df = 0.0, p = 0.0;  ///< corrected for ties; p by χ²
  double epsilon_squared = 0.0;       ///< H/(n − 1)
};
/// Errors: as one_way(), and all values equal.
core::Result<KruskalWallis> kruskal_wallis(const Groups& groups);
struct ExactKruskal {
  double as_extreme = 0.0, arrangements = 0.0;  ///< counts, whole
  double p = 0.0;
};
/// The same test by counting every way to deal the values to groups of these sizes. Errors: as
/// kruskal_wallis(); too_large over 20 million ways.
core::Result<ExactKruskal> kruskal_wallis_exact(const Groups& groups);
/// Fligner & Killeen: equality of spread by normal scores of the ranks of |y − median|.
core::Result<SpreadTest> fligner_killeen(const Groups& groups);

struct Friedman {
  double chi_squared = 0.0, df = 0.0, p = 0.0;
  double kendall_w = 0.0;  ///< agreement of the subjects, 0 … 1
};
/// @param values  [subject][level], at least 2 × 2. Errors: bad_input, also where all rows are
/// ties.
core::Result<Friedman> friedman(const Matrix& values);

struct Page {
  double l = 0.0, mean = 0.0, variance = 0.0, z = 0.0;
  double p_rising = 0.0;  ///< one-sided, normal approximation
};
/// Do the levels rise in the order of the columns? (Page 1963.) For falling ones pass −values.
core::Result<Page> page_trend(const Matrix& values);

struct RankTest {
  double statistic = 0.0, p = 0.0;  ///< exact, two-sided
};
/// Wilcoxon's signed ranks of x − y (zeros left out): V, the sum over positive differences. Exact
/// by counting, ties included, for up to 200 pairs.
core::Result<RankTest> wilcoxon_signed_rank(const Vector& differences);

struct MannWhitney {
  double w = 0.0, p = 0.0;   ///< pairs with x > y, ties half; exact, two-sided
  double cliff_delta = 0.0;  ///< P(x > y) − P(x < y)
};
/// Exact by counting, ties included, for up to 200 values in all.
core::Result<MannWhitney> mann_whitney(const Vector& x, const Vector& y);

struct Correlation {
  double r = 0.0, statistic = 0.0, p = 0.0;  ///< p of the approximation
  std::optional<double> p_exact;             ///< two-sided, where it can be counted
};
/// Spearman's ρ with its t approximation; exact over every arrangement of the ranks, ties included,
/// for up to 4 million of them (10 pairs without ties). Kendall's τ_b with z corrected for ties
/// (counted in n log n, Knight 1966); exact without ties for up to 50 pairs.
core::Result<Correlation> spearman(const Vector& x, const Vector& y);
core::Result<Correlation> kendall(const Vector& x, const Vector& y);

}  // namespace tractus::statistics
