#include "lab/rigs/palpation/noise.hpp"

#include <algorithm>
#include <cmath>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

/// Median of the square of three normal numbers over its mean: of χ² with 3 degrees of freedom, over 3.
constexpr double kMedianOfThreeSquares = 2.36597 / 3.0;
constexpr const auto& kNoise = kSettings.palpation_fit;

/// Median of the errors' squares over what is expected of them; 1 if noise of that size is all.
template <class Expected>
double times_expected(const std::vector<NoiseSample>& samples, Expected expected) {
  std::vector<double> ratios;
  for (const NoiseSample& s : samples) ratios.push_back(s.error / expected(s));
  return value_at_share(std::move(ratios), 0.5) / kMedianOfThreeSquares;
}

/// The samples whose squares of motion over sensor lie within bounds, none if there are too few.
std::vector<NoiseSample> where_ratio_within(const std::vector<NoiseSample>& samples, double least,
                                            double below) {
  std::vector<NoiseSample> out;
  for (const NoiseSample& s : samples)
    if (s.motion >= least * s.sensor && s.motion < below * s.sensor) out.push_back(s);
  if (out.size() < kNoise.least_for_noise) out.clear();
  return out;
}

/// The factor of the motion's squares at which the median is that of noise, by bisection; at least 1.
double motion_factor(const std::vector<NoiseSample>& telling, double of_sensor) {
  double low = 1.0, high = 1e4;
  if (telling.empty()) return low;
  while (high / low > 1.001) {
    const double middle = std::sqrt(low * high);
    const double times = times_expected(
        telling, [&](const NoiseSample& s) { return of_sensor * s.sensor + middle * s.motion; });
    (times > 1.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

double value_at_share(std::vector<double> values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double judged_noise(const std::vector<NoiseSample>& samples) {
  if (samples.empty()) return 0.0;
  std::vector<double> ratios;
  for (const NoiseSample& s : samples) ratios.push_back(s.motion / s.sensor);
  const double most = std::clamp(value_at_share(std::move(ratios), 1.0 - kNoise.telling_share),
                                 kNoise.motion_does_nothing, kNoise.motion_does_most);
  const auto still = where_ratio_within(samples, 0.0, kNoise.motion_does_nothing);
  const double of_sensor =
      still.empty()
          ? 1.0
          : std::max(1.0, times_expected(still, [](const NoiseSample& s) { return s.sensor; }));
  const double of_motion = motion_factor(where_ratio_within(samples, most, HUGE_VAL), of_sensor);
  double sum = 0.0, count = 0.0;
  for (const NoiseSample& s : samples)
    if (s.judged) sum += of_sensor * s.sensor + of_motion * s.motion, count += 1.0;
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace lab
}  // namespace tractus
