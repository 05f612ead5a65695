#include "lab/rigs/palpation/tract_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kMap = kSettings.tract_map;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

Range touched(const Samples& samples, std::size_t depth) {
  Range out;
  for (const TrialSamples& trial : samples.trials)
    for (const float value : trial.features[depth])
      out.low = std::min(out.low, double(value)), out.high = std::max(out.high, double(value));
  return out;
}

bool touches(const Samples& samples, const TrialSamples& trial, std::size_t row) {
  const std::size_t phase = samples.feature("phase");
  return phase == samples.features.size() ||
         samples.features[phase].words[std::size_t(trial.features[phase][row])] != "free";
}

}  // namespace

std::optional<TractMap> tract_map(const Samples& samples) {
  const std::size_t depth = samples.feature("depth"), angle = samples.feature("wall angle");
  if (depth == samples.features.size() || angle == samples.features.size()) return std::nullopt;
  const Range range = touched(samples, depth);
  if (!(range.high > range.low)) return std::nullopt;
  TractMap map;
  for (std::size_t k = 0; k <= kMap.depths; ++k)
    map.depth_m.push_back(range.low + (range.high - range.low) * double(k) / double(kMap.depths));
  const double turn = 2.0 * std::numbers::pi;
  for (std::size_t k = 0; k <= kMap.angles; ++k)
    map.angle_rad.push_back(turn * double(k) / double(kMap.angles));
  std::vector<double> squares(kMap.depths * kMap.angles, 0.0), counts(squares.size(), 0.0);
  double all = 0.0;
  for (const TrialSamples& trial : samples.trials)
    for (std::size_t row = 0; row < trial.rows(); ++row) {
      if (!trial.is_judged(row * trial.stride) || !touches(samples, trial, row)) continue;
      const double d = (double(trial.features[depth][row]) - range.low) / (range.high - range.low);
      double a = std::fmod(double(trial.features[angle][row]), turn) / turn;
      if (a < 0.0) a += 1.0;
      const auto bin = [](double share, std::size_t bins) {
        return std::min(bins - 1, std::size_t(share * double(bins)));
      };
      const std::size_t cell = bin(d, kMap.depths) * kMap.angles + bin(a, kMap.angles);
      const double square = samples.squared(trial, row * trial.stride);
      squares[cell] += square, counts[cell] += 1.0, all += square;
    }
  for (std::size_t c = 0; c < squares.size(); ++c) {
    const bool known = counts[c] >= kMap.least_samples;
    map.rmse.push_back(known ? std::sqrt(squares[c] / counts[c])
                             : std::numeric_limits<double>::quiet_NaN());
    map.share.push_back(all > 0.0 ? squares[c] / all : 0.0);
  }
  return map;
}

}  // namespace lab
}  // namespace tractus
