#include "station/check/durations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "station/check/findings.hpp"

namespace tractus::check {

double Durations::quantile_s(double share) const {
  if (kept_.empty()) return 0.0;
  std::vector<core::Instant_ns> sorted = kept_;
  std::ranges::sort(sorted);
  const double rank = std::ceil(share * double(sorted.size()));  // the nearest-rank quantile
  const auto at = std::clamp<std::size_t>(std::size_t(rank), 1, sorted.size()) - 1;
  return 1e-9 * double(sorted[at]);
}

std::string Durations::text() const {
  const auto at = [&](double share) { return spelled(quantile_s(share), "s"); };
  return fmt::format("p50 {}, p99 {}, longest {}", at(0.5), at(0.99), at(1.0));
}

}  // namespace tractus::check
