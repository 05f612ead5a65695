#include "station/check/durations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace check {

double Durations::quantile_s(double share) const {
  if (kept_.empty()) return 0.0;
  std::vector<core::Instant_ns> sorted = kept_;
  std::ranges::sort(sorted);
  const double rank = std::ceil(share * double(sorted.size()));  // the nearest-rank quantile
  const auto at = std::clamp<std::size_t>(std::size_t(rank), 1, sorted.size()) - 1;
  return 1e-9 * double(sorted[at]);
}

std::string Durations::text() const {
  return fmt::format("p50 {:.3g} µs, p99 {:.3g} µs, longest {:.3g} µs", 1e6 * quantile_s(0.5),
                     1e6 * quantile_s(0.99), 1e6 * quantile_s(1.0));
}

}  // namespace check
