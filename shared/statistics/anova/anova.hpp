/// One-way analysis of variance, its unequal-variance form, and tests of equal spread.
///
///     F = [Σ n_j (m_j − m)² / (k − 1)] / [Σ Σ (y_ij − m_j)² / (N − k)]
///
/// Sums are of exact differences from one observation, in 80-bit arithmetic and two passes, so that
/// data with ten equal leading digits lose none of the others.
/// Assumes independent observations: trials of one person are not (see rm_anova.hpp, lmm.hpp).
#pragma once

#include <string>
#include <vector>

#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Groups {
  std::vector<std::string> names;  ///< in order of first appearance
  std::vector<Vector> values;      ///< one vector per name
};

/// Sorts observations by their label. Names keep the order in which they first appear.
Groups grouped(const std::vector<std::string>& labels, const Vector& values);

/// The same from places: value i belongs to names[places[i]].
Groups grouped(const std::vector<std::size_t>& places, std::vector<std::string> names,
               const Vector& values);

struct OneWay {
  std::vector<double> means, deviations;  ///< per group; deviation with n − 1, NaN for one value
  double grand_mean = 0.0;
  double ss_between = 0.0, ss_within = 0.0;
  double df_between = 0.0, df_within = 0.0;
  double f = 0.0, p = 0.0;
  double residual_sd = 0.0;
  double eta_squared = 0.0, omega_squared = 0.0, epsilon_squared = 0.0, cohen_f = 0.0;
};

/// A test whose statistic is F with these degrees of freedom (df2 = 0: a χ² on df1).
struct SpreadTest {
  double statistic = 0.0, df1 = 0.0, df2 = 0.0, p = 0.0;
};

/// All of these: bad_input for fewer than two groups, an empty group (named), a number that is not
/// finite, or no variation within groups.
core::Result<OneWay> one_way(const Groups& groups);
/// Welch 1951: no assumption of equal variances. Each group needs two different values.
core::Result<SpreadTest> welch(const Groups& groups);
/// Equality of spread: ANOVA of |y − mean| (Levene 1960) or of |y − median| (Brown & Forsythe
/// 1974).
core::Result<SpreadTest> levene(const Groups& groups);
core::Result<SpreadTest> brown_forsythe(const Groups& groups);
/// Bartlett 1937; sensitive to departures from normality.
core::Result<SpreadTest> bartlett(const Groups& groups);

struct TukeyPair {
  std::string pair;                                ///< "b-a": mean of b minus mean of a
  double difference = 0.0, low = 0.0, high = 0.0;  ///< simultaneous 95 %
  double p = 0.0;
};

/// Tukey–Kramer honest significant differences of all pairs.
core::Result<std::vector<TukeyPair>> tukey(const Groups& groups);

}  // namespace tractus::statistics
