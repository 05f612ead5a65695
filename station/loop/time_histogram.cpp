#include "station/loop/time_histogram.hpp"

#include <cmath>

namespace tractus::loop {

double TimeHistogram::quantile_us(double share) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    seen += bins_[bin];
    if (seen >= wanted && seen > 0) return static_cast<double>(bin + 1);
  }
  return 0.0;
}

}  // namespace tractus::loop
