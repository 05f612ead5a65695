/// Piecewise-linear functions over knots.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tractus::lab {

/// Where a value lies between the knots: the first of the two, and the weight of the second, 0 … 1. Beyond the ends the
/// end's value holds. @param knots  two at least, rising.
inline std::pair<std::size_t, double> place_between(const std::vector<double>& knots, double v) {
  const auto above = std::size_t(std::ranges::upper_bound(knots, v) - knots.begin());
  const std::size_t at = std::clamp<std::size_t>(above, 1, knots.size() - 1) - 1;
  return {at, std::clamp((v - knots[at]) / (knots[at + 1] - knots[at]), 0.0, 1.0)};
}

}  // namespace tractus::lab
