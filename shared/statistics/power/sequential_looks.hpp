/// Looking at a study's data before it is complete, without more false findings than α.
///
/// At look k a share t_k of the information (surgeons, trials) is there. Under no effect the sums
/// S_k = z_k √t_k are a Brownian motion at t_1 < … < t_K = 1 [Armitage1969]; α is spent as t grows
/// [Lan1983], each half on one side, and z_k is significant beyond c_k:
///
///     O'Brien–Fleming   α(t) = 4 (1 − Φ(z_{1−α/4} / √t))     late: little is lost at the end
///     Pocock            α(t) = α ln(1 + (e − 1) t)           even
///     P(|S_1| < c_1 √t_1, …, |S_k| ≥ c_k √t_k) = α(t_k) − α(t_{k−1})
///
/// The density of S_k on what was not stopped is integrated from look to look by Simpson's rule.
/// The bounds are of normal z: with t, compare its p with the nominal p of the look.
#pragma once

#include <vector>

#include "core/result.hpp"

namespace tractus::statistics {

enum class Spending { obrien_fleming, pocock };

struct Looks {
  std::vector<double> shares;      ///< t_k
  std::vector<double> bounds;      ///< c_k, of |z|
  std::vector<double> nominal_p;   ///< 2 (1 − Φ(c_k))
  std::vector<double> spent;       ///< α(t_k)
  std::vector<double> stopped_by;  ///< P(stopped at look k or before) with the effect planned for
  double inflation = 1.0;          ///< of the largest size, against one look of the same power
  double mean_share = 1.0;         ///< of the largest size that is used, with that effect
};

/// @param shares  increasing, the last 1. @param power  of the planned effect, with all looks.
/// Errors: bad_input for shares that do not increase to 1, or more than 50.
core::Result<Looks> sequential_looks(const std::vector<double>& shares, Spending spending,
                                     double alpha, double power);

}  // namespace tractus::statistics
