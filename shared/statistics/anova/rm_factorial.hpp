/// Repeated measures with several within-subject factors, and one between subjects.
///
///     Z = Y C,  C orthonormal contrasts of the effect (Kronecker product over the factors:
///     contrasts of those in the effect, the mean over the others) SS_error = Σ ‖z_i − z̄_group(i)‖²
///     on  q (n − g) within effect:  SS = ‖mean of the group means‖² / (Σ 1/n_g / g²)        (type
///     III) × group:        SS = Σ n_g ‖z̄_g − z̄‖²  on  q (g − 1);  q = 1, the mean: the group
///     effect ε from the pooled covariance of Z on n − g, as in rm_anova.hpp (Huynh–Feldt in
///     Lecoutre's form, with n − g + 1 for n)
///
/// Source: the multivariate formulation of O'Brien & Kaiser 1985. With one factor and one group it
/// is rm_anova().
#pragma once

#include "statistics/anova/rm_anova.hpp"

namespace tractus::statistics {

struct RmDesign {
  Matrix values;                     ///< [subject][cell], the last factor fastest
  std::vector<Eigen::Index> levels;  ///< per within factor; their product is the number of cells
  std::vector<std::size_t> group;    ///< per subject, 0 … g − 1; empty: one group
};

struct RmEffect {
  std::vector<std::size_t> within;  ///< factors in the effect; empty: the mean over all
  bool with_group = false;
  double ss = 0.0, ss_error = 0.0, df1 = 0.0, df2 = 0.0, f = 0.0;
  double p = 0.0;  ///< as if sphericity held
  double epsilon_gg = 1.0, p_gg = 0.0;
  double epsilon_hf = 1.0, p_hf = 0.0;  ///< ε uncapped; p with min(1, ε)
  Mauchly mauchly;
  double partial_eta_squared = 0.0;
  double generalized_eta_squared = 0.0;  ///< of all error, Olejnik & Algina 2003
};

/// Every effect: the group's, each within effect, each with the group; main effects first.
/// Errors: bad_input for fewer than two subjects in each group, a value that is not finite, no
/// error left; too_large over 6 factors.
core::Result<std::vector<RmEffect>> rm_factorial(const RmDesign& design);

}  // namespace tractus::statistics
