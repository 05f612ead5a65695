/// Repeated-measures analysis of variance, one within-subject factor.
///
///     F = [n Σ_j (m_·j − m)² / (k − 1)] / [Σ Σ (y_ij − m_i· − m_·j + m)² / ((k − 1)(n − 1))]
///     C = H S H,  H = I − 11ᵀ/k,  S the covariance of the levels
///     ε_GG = (tr C)² / ((k − 1) tr C²)                          Greenhouse & Geisser 1959
///     ε_HF = (n (k − 1) ε_GG − 2) / ((k − 1)(n − 1 − (k − 1) ε_GG))   Huynh & Feldt 1976
///
/// Report the Greenhouse–Geisser p; Mauchly's test has little power in the few subjects there are.
#pragma once

#include "statistics/anova/sphericity.hpp"

namespace tractus::statistics {

struct RmAnova {
  Vector level_means;
  double ss_effect = 0.0, ss_subjects = 0.0, ss_error = 0.0;
  double df1 = 0.0, df2 = 0.0, f = 0.0;
  double p = 0.0;  ///< as if sphericity held
  double epsilon_gg = 0.0, p_gg = 0.0;
  double epsilon_hf = 0.0, p_hf = 0.0;  ///< ε uncapped; p with min(1, ε)
  double epsilon_lower = 0.0, p_lower = 0.0;
  Mauchly mauchly;
  double partial_eta_squared = 0.0, generalized_eta_squared = 0.0, partial_omega_squared = 0.0;
};

/// @param values  [subject][level], finite, at least 2 × 2.
/// Errors: bad_input for fewer, for a number that is not finite, and where nothing is left to
/// error.
core::Result<RmAnova> rm_anova(const Matrix& values);

struct Contrast {
  double estimate = 0.0, standard_error = 0.0, t = 0.0, df = 0.0, p = 0.0;
  double ci_low = 0.0, ci_high = 0.0;  ///< 95 %
};

/// Mean of Σ_j w_j y_ij over subjects, tested by its own spread: no sphericity needed. A spread of
/// 0 gives t of ±infinity, or NaN where the mean is 0 too.
Contrast contrast(const Matrix& values, const Vector& weights);
/// Weights j − (k + 1)/2, scaled so that neighbours differ by 1.
Contrast linear_trend(const Matrix& values);

}  // namespace tractus::statistics
