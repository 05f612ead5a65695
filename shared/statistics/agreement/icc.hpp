/// Reliability: how much of the spread between measurements is between subjects.
///
/// Shrout & Fleiss 1979 [Shrout1979]; intervals after McGraw & Wong 1996 [McGraw1996].
#pragma once

#include "statistics/distributions/proportions.hpp"
#include "statistics/regression/design.hpp"

namespace tractus::statistics {

struct Icc {
  double ms_rows = 0.0, ms_columns = 0.0, ms_error = 0.0, ms_within = 0.0;
  double icc1 = 0.0, icc2 = 0.0, icc3 = 0.0;     ///< of one measurement
  double icc1k = 0.0, icc2k = 0.0, icc3k = 0.0;  ///< of the mean of all k
  Interval icc1_95, icc2_95, icc3_95;
  Interval icc2k_95;
  double f1 = 0.0, p1 = 0.0, f23 = 0.0, p23 = 0.0;  ///< tests of no spread between subjects
  double sem_agreement = 0.0;      ///< √(MS_within): includes drift over repetitions
  double sem_consistency = 0.0;    ///< √(MS_error)
  double mdc95_consistency = 0.0;  ///< z(0.975) √2 SEM: the smallest change beyond error
};

/// @param values  [subject][repetition], finite, at least 2 × 2.
/// Errors: bad_input for fewer, not finite, or no spread left to error.
core::Result<Icc> icc(const Matrix& values);

}  // namespace tractus::statistics
