/// Signal detection: how well breaches are told from none, apart from the readiness to say so.
///
///     d′ = z(h) − z(f),  c = −(z(h) + z(f))/2,  ln β = d′ c,  AUC = Φ(d′/√2)   (equal variance)
///     var d′ = h(1 − h)/(n_s φ²(z_h)) + f(1 − f)/(n_n φ²(z_f))   Gourevitch & Galanter 1967
///
/// With six signals and six blanks the corrected d′ cannot exceed 2.93 in size.
#pragma once

#include "statistics/distributions/proportions.hpp"

namespace tractus::statistics {

/// What to do about rates of 0 and 1, whose z is infinite.
enum class RateCorrection {
  none,
  log_linear,  ///< (x + ½)/(n + 1) always (Hautus 1995); the one to report
  extremes     ///< 0 → ½/n, 1 → 1 − ½/n
};

struct SignalDetection {
  double hit_rate = 0.0, false_alarm_rate = 0.0;  ///< as corrected
  double d_prime = 0.0, criterion = 0.0;          ///< c > 0: slow to say "breach"
  double relative_criterion = 0.0;                ///< c / d′
  double beta = 0.0, ln_beta = 0.0;
  double a_prime = 0.0;  ///< Grier 1971, without assumptions on the distributions
  double auc = 0.0;
  double variance = 0.0;  ///< of d′
  Interval d_prime_95;
};

/// @param hits  of the trials with a breach;  @param false_alarms  of those without.
/// Errors: bad_input for a rate of 0 or 1 without correction.
core::Result<SignalDetection> signal_detection(
    const Proportion& hits, const Proportion& false_alarms,
    RateCorrection correction = RateCorrection::log_linear);

}  // namespace tractus::statistics
