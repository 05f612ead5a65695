#include "lab/signal/saturation.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace lab {
namespace {

/// Of one run in a whole channel that noise alone would leave alike. Prior.
constexpr double kChance = 1e-3;
/// Noise below this share of a usual step between neighbours is not visible. Prior.
constexpr double kVisible = 0.01;
/// Fewer samples do not say how often neighbours are alike. Bound.
constexpr std::size_t kFewest = 100;

double usual_step(std::span<const double> y) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (const double step = std::abs(y[k] - y[k - 1]); step > 0.0) steps.push_back(step);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

}  // namespace

std::vector<char> saturated(std::span<const double> y, double noise_sd) {
  std::vector<char> out(y.size(), 0);
  if (y.size() < kFewest || !(noise_sd > kVisible * usual_step(y))) return out;
  const auto [least, most] = std::ranges::minmax(y);
  const auto at_end = [&](double value) { return value == least || value == most; };
  double alike = 0.0, pairs = 0.0;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (!at_end(y[k])) ++pairs, alike += y[k] == y[k - 1] ? 1.0 : 0.0;
  const double chance = (alike + 1.0) / (pairs + 2.0);  // Laplace's rule of succession
  const double longest = 1.0 + std::log(kChance / double(y.size())) / std::log(chance);
  for (std::size_t from = 0, to = 0; from < y.size(); from = to) {
    for (to = from + 1; to < y.size() && y[to] == y[from]; ++to) {
    }
    if (at_end(y[from]) && double(to - from) > longest)
      std::fill(out.begin() + std::ptrdiff_t(from), out.begin() + std::ptrdiff_t(to), 1);
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
