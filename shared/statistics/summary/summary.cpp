#include "statistics/summary/summary.hpp"

#include <cmath>

namespace tractus::statistics {

Summary summary(const Vector& values) {
  using Extended = Eigen::Array<long double, Eigen::Dynamic, 1>;
  core::require(values.size() > 0, "a summary is of at least one value");
  const auto n = static_cast<long double>(values.size());
  const long double shift = values[0];
  Extended d = values.cast<long double>().array() - shift;
  const long double mean = d.mean();
  d -= mean;
  const long double rest = d.mean();
  d -= rest;
  const long double squares = d.square().sum();
  const long double lagged = (d.head(d.size() - 1) * d.tail(d.size() - 1)).sum();
  return {static_cast<double>(shift + (mean + rest)),
          static_cast<double>(std::sqrt(squares / (n - 1.0L))),
          static_cast<double>(lagged / squares)};
}

}  // namespace tractus::statistics
