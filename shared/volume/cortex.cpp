#include "volume/cortex.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace tractus {
namespace volume {
namespace {

constexpr std::size_t kFewest = 8;  // values of a profile
constexpr double kLeastDensity = 1000.0;
constexpr double kDensestOf = 50.0;
constexpr double kThinnest_m = 1e-4, kThickest_m = 4e-3, kFarthest_m = 1.25e-3;
constexpr std::array kOuterStarts_m{-1e-3, -5e-4, 0.0, 5e-4, 1e-3};
constexpr std::array kThicknessStarts_m{3e-4, 6e-4, 1e-3, 1.6e-3, 2.5e-3};
constexpr std::size_t kStarts = 3;
constexpr double kFirstStep_m = 2e-4, kLastStep_m = 2e-5;
constexpr std::array kSigmas_m{2e-4, 3e-4, 4.5e-4, 6e-4, 8e-4, 1.1e-3, 1.6e-3};

/// The normal distribution's function, from a table: true to 2e-6.
class Step {
 public:
  Step() {
    for (std::size_t n = 0; n < values_.size(); ++n)
      values_[n] = 0.5 * std::erfc((kReach - double(n) / kPerUnit) / std::numbers::sqrt2);
  }
  double at(double x) const {
    const double place = (std::clamp(x, -kReach, kReach) + kReach) * kPerUnit;
    const auto n = std::min(std::size_t(place), values_.size() - 2);
    return values_[n] + (place - double(n)) * (values_[n + 1] - values_[n]);
  }

 private:
  static constexpr double kReach = 6.0, kPerUnit = 128.0;
  std::array<double, std::size_t(2.0 * kReach * kPerUnit) + 1> values_;
};
const Step kStepFunction;

/// The model at given x₀ and thickness, with the best y₀ and y₂.
CortexFit solved(const CortexProfile& profile, const CortexScan& scan, double outer_m,
                 double thickness_m) {
  double ii = 0.0, io = 0.0, oo = 0.0, iy = 0.0, oy = 0.0, yy = 0.0;
  for (std::size_t n = 0; n < profile.values.size(); ++n) {
    const double x = profile.from_m + double(n) * profile.step_m;
    const double o = kStepFunction.at((x - outer_m) / scan.sigma_m),
                 i = 1.0 - kStepFunction.at((x - outer_m + thickness_m) / scan.sigma_m);
    const double y = profile.values[n] - scan.density * (1.0 - i - o);
    ii += i * i, io += i * o, oo += o * o, iy += i * y, oy += o * y, yy += y * y;
  }
  CortexFit out{.outer_m = outer_m, .thickness_m = thickness_m};
  const double det = ii * oo - io * io;
  out.rms = std::numeric_limits<double>::infinity();
  if (!(det > 1e-9 * (ii + oo) * (ii + oo))) return out;
  out.inside = (iy * oo - oy * io) / det, out.outside = (oy * ii - iy * io) / det;
  const double square = yy - out.inside * iy - out.outside * oy;
  out.rms = std::sqrt(std::max(0.0, square) / double(profile.values.size()));
  return out;
}

bool allowed(double outer_m, double thickness_m) {
  return std::abs(outer_m) <= kFarthest_m && thickness_m >= kThinnest_m &&
         thickness_m <= kThickest_m;
}

/// Steps to the best of eight neighbours, and halves the step where none is better.
CortexFit refined(const CortexProfile& profile, const CortexScan& scan, CortexFit best) {
  for (double step_m = kFirstStep_m; step_m > kLastStep_m;) {
    const CortexFit from = best;
    for (const auto& [a, b] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
      const double outer_m = from.outer_m + a * step_m, thick_m = from.thickness_m + b * step_m;
      if (!allowed(outer_m, thick_m)) continue;
      const CortexFit there = solved(profile, scan, outer_m, thick_m);
      if (there.rms < best.rms) best = there;
    }
    if (best.rms >= from.rms) step_m *= 0.5;
  }
  return best;
}

/// Infinite where the model fits less than half of them.
double median_rms(std::span<const CortexProfile> profiles, const CortexScan& scan) {
  std::vector<double> each;
  for (const CortexProfile& profile : profiles)
    if (const auto fit = fit_cortex(profile, scan)) each.push_back(fit->rms);
  if (2 * each.size() < profiles.size()) return std::numeric_limits<double>::infinity();
  const auto middle = each.begin() + std::ptrdiff_t(each.size() / 2);
  std::ranges::nth_element(each, middle);
  return *middle;
}

}  // namespace

std::optional<CortexFit> fit_cortex(const CortexProfile& profile, const CortexScan& scan) {
  if (profile.values.size() < kFewest) return std::nullopt;
  std::vector<CortexFit> starts;
  for (const double outer_m : kOuterStarts_m)
    for (const double thickness_m : kThicknessStarts_m)
      starts.push_back(solved(profile, scan, outer_m, thickness_m));
  std::ranges::partial_sort(starts, starts.begin() + kStarts, {}, &CortexFit::rms);
  CortexFit best = starts.front();
  for (std::size_t n = 0; n < kStarts; ++n) {
    const CortexFit fit = refined(profile, scan, starts[n]);
    if (fit.rms < best.rms) best = fit;
  }
  const bool at_a_bound = best.thickness_m < 1.5 * kThinnest_m ||
                          best.thickness_m > 0.95 * kThickest_m ||
                          std::abs(best.outer_m) > 0.95 * kFarthest_m;
  if (at_a_bound || !std::isfinite(best.rms)) return std::nullopt;
  return best;
}

std::optional<CortexScan> cortex_scan_of(std::span<const CortexProfile> profiles) {
  std::vector<double> peaks;
  for (const CortexProfile& profile : profiles)
    if (!profile.values.empty()) peaks.push_back(std::ranges::max(profile.values));
  if (peaks.empty()) return std::nullopt;
  const auto at = peaks.begin() + std::ptrdiff_t(double(peaks.size()) * (1.0 - 1.0 / kDensestOf));
  std::ranges::nth_element(peaks, at);
  CortexScan out{.density = std::max(kLeastDensity, *at), .sigma_m = 0.0};
  std::array<double, kSigmas_m.size()> left{};
  tbb::parallel_for(std::size_t(0), left.size(), [&](std::size_t n) {
    left[n] = median_rms(profiles, {out.density, kSigmas_m[n]});
  });
  const auto least = std::ranges::min_element(left);
  out.sigma_m = kSigmas_m[std::size_t(least - left.begin())];
  if (!std::isfinite(*least)) return std::nullopt;
  return out;
}

}  // namespace volume
}  // namespace tractus
