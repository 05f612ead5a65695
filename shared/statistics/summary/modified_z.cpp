#include "statistics/summary/modified_z.hpp"

#include <algorithm>

#include "core/require.hpp"

namespace tractus::statistics {

double median(std::vector<double> values) {
  core::require(!values.empty(), "a median is of at least one value");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*std::max_element(values.begin(), middle) + *middle);
}

ModifiedZ modified_z(const Eigen::VectorXd& values) {
  ModifiedZ out;
  out.median = median({values.begin(), values.end()});
  const Eigen::VectorXd from_median = values.array() - out.median;
  const Eigen::VectorXd size = from_median.cwiseAbs();
  out.mad = median({size.begin(), size.end()});
  out.mean_deviation = size.mean();
  out.by_mean_deviation = out.mad == 0.0;
  const double scale = out.by_mean_deviation ? 1.253314 * out.mean_deviation : out.mad / 0.6745;
  out.z = scale > 0.0 ? Eigen::VectorXd(from_median / scale)
                      : Eigen::VectorXd(Eigen::VectorXd::Zero(values.size()));
  return out;
}

}  // namespace tractus::statistics
