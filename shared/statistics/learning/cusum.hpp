/// When is a trainee competent? Cumulative sums of successes and failures.
///
///     LC-CUSUM: S_t = max(0, S_t−1 + W),  W = ln((1 − p_a)/(1 − p_i)) on success,
///               ln(p_a/p_i) on failure; competence is signalled when S_t ≥ h (Biau & Porcher 2010)
///     CUSUM:    the same with both signs turned: deterioration is signalled (Page 1954)
///
/// p_a and p_i are the failure rates of adequate and inadequate performance.
#pragma once

#include <vector>

#include "core/result.hpp"

namespace tractus::statistics {

struct Rates {
  double adequate = 0.10, inadequate = 0.25;  ///< 0 < adequate < inadequate < 1
  static core::Result<Rates> make(double adequate, double inadequate);
};

/// S after each trial, from 0. It is not reset at a signal.
std::vector<double> lc_cusum(const std::vector<bool>& failures, const Rates& rates);
std::vector<double> deterioration_cusum(const std::vector<bool>& failures, const Rates& rates);

/// What LC-CUSUM does to a trainee with a constant chance of failure, exactly, by dynamic
/// programming over its reachable sums.
struct OperatingCharacteristic {
  std::vector<double> signalled_by;  ///< [t]: probability of a signal within t + 1 trials
  double mean_run_length = 0.0;      ///< trials to the signal, those without one counted at the end
};

/// @param threshold  h > 0;  @param failure  in [0, 1];  @param trials  1 … 1000.
OperatingCharacteristic lc_cusum_characteristic(const Rates& rates, double threshold,
                                                double failure, int trials);

/// Wald's sequential probability ratio test of H₀ "fails as often as adequate" against H₁ "as
/// inadequate": the same steps as deterioration, never reset (Wald 1945).
///
///     S_t = Σ ln(p_i/p_a) on failure, ln((1 − p_i)/(1 − p_a)) on success
///     inadequate at S ≥ ln((1 − β)/α), adequate at S ≤ ln(β/(1 − α))
struct SprtBounds {
  double upper = 0.0, lower = 0.0;
};
/// @param alpha, beta  chances of calling adequate inadequate, and the reverse, > 0, together < 1.
SprtBounds sprt_bounds(double alpha, double beta);

struct Sprt {
  enum class Verdict { undecided, adequate, inadequate };
  std::vector<double> sums;  ///< after each trial, going on past the verdict
  Verdict verdict = Verdict::undecided;
  std::size_t decided_at = 0;  ///< trial of the verdict, from 1; 0: none
};
Sprt sprt(const std::vector<bool>& failures, const Rates& rates, const SprtBounds& bounds);

/// What the test does to a trainee with a constant chance of failure, exactly.
struct SprtCharacteristic {
  double adequate = 0.0, inadequate = 0.0;  ///< probability of each verdict within the trials
  double mean_trials = 0.0;  ///< to the verdict, those without one counted at the end
};
/// @param failure  in [0, 1];  @param trials  1 … 1000.
SprtCharacteristic sprt_characteristic(const Rates& rates, const SprtBounds& bounds, double failure,
                                       int trials);

/// The first place, from 1, where `sums` reach `limit`; 0 for none.
std::size_t first_at(const std::vector<double>& sums, double limit);

}  // namespace tractus::statistics
