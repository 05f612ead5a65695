/// Modified Z-scores: outliers judged by the median, which they cannot move.
///
///     z_i = 0.6745 (x_i − median) / MAD          Iglewicz & Hoaglin 1993; |z| > 3.5 is an outlier
///     z_i = (x_i − median) / (1.253314 · mean |x − median|)   where MAD = 0 (IBM's convention)
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tractus::statistics {

/// Middle of the sorted values, the mean of the two middle ones for an even number; at least one.
double median(std::vector<double> values);

struct ModifiedZ {
  double median = 0.0;
  double mad = 0.0;                ///< median |x − median|
  double mean_deviation = 0.0;     ///< mean |x − median|
  Eigen::VectorXd z;               ///< one per value; all 0 when the values are equal
  bool by_mean_deviation = false;  ///< was MAD 0?
};

/// At least one finite value.
ModifiedZ modified_z(const Eigen::VectorXd& values);

}  // namespace tractus::statistics
