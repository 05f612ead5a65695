#include "lab/signal/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>

namespace tractus {
namespace lab {
namespace {

/// Noise below this share of a usual step between neighbours is not visible. Prior.
constexpr double kVisible = 0.01;
/// Fewer samples at an extreme value may be chance. Prior.
constexpr std::size_t kFewest = 8;
/// Times the samples of the next values inwards. A smooth peak without noise has 1. Prior.
constexpr std::size_t kPile = 2;
/// So many next values are looked at.
constexpr std::size_t kNeighbours = 3;

double usual_step(std::span<const double> y) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (const double step = std::abs(y[k] - y[k - 1]); step > 0.0) steps.push_back(step);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// The first value of `counts` if samples pile up at it.
template <typename Counts>
std::optional<double> end_of(const Counts& counts) {
  if (counts.size() <= kNeighbours) return std::nullopt;
  auto at = counts.begin();
  const auto [extreme, samples] = *at;
  std::size_t next = 0;
  for (std::size_t k = 0; k < kNeighbours; ++k) next += (++at)->second;
  if (samples < kFewest || samples <= kPile * next) return std::nullopt;
  return extreme;
}

/// Samples of each of the first values by `Order`, the extreme and its neighbours.
template <typename Order>
std::map<double, std::size_t, Order> first_values(
    std::span<const std::span<const double>> recordings) {
  std::map<double, std::size_t, Order> counts;
  for (const auto& recording : recordings)
    for (const double value : recording) {
      if (counts.size() > kNeighbours && Order{}(counts.rbegin()->first, value)) continue;
      ++counts[value];
      if (counts.size() > kNeighbours + 1) counts.erase(std::prev(counts.end()));
    }
  return counts;
}

}  // namespace

bool shows_noise(std::span<const double> recording, double noise_sd) {
  return noise_sd > kVisible * usual_step(recording);
}

SensorRange sensor_range(std::span<const std::span<const double>> recordings) {
  return {.least = end_of(first_values<std::less<>>(recordings)),
          .most = end_of(first_values<std::greater<>>(recordings))};
}

}  // namespace lab
}  // namespace tractus
