/// A force that comes back with the depth, as of a lead screw or of a motor's poles:
/// F = A sin(2π x/p + φ).
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class ForceRipple final : public ProbeForce {
 public:
  explicit ForceRipple(std::span<const double> values)
      : amplitude_N_(values[0]),
        wave_rad_per_m_(2.0 * std::numbers::pi / values[1]),
        phase_rad_(values[2]) {}
  double force_N(const ProbingTick& tick, double, ProbingMemory&) const noexcept override {
    return amplitude_N_ * std::sin(wave_rad_per_m_ * tick.x_m + phase_rad_);
  }

 private:
  double amplitude_N_, wave_rad_per_m_, phase_rad_;
};

/// A moment of the recordings: its residual over the square of its standard deviation, and one over
/// that square.
struct Moment {
  double depth_m, weighted, weight;
};

std::vector<Moment> moments(const ProbingStatistics& r) {
  const std::size_t stride = 1 + r.depth_m.size() / 8000;
  std::vector<Moment> out;
  for (std::size_t k = 0; k < r.depth_m.size(); k += stride) {
    const double sd_N = r.residual_sd_N[k];
    out.push_back({r.depth_m[k], std::clamp(r.residual[k], -1e3, 1e3) / sd_N, 1.0 / (sd_N * sd_N)});
  }
  return out;
}

/// A sine and cosine of the depth in the residual.
struct Wave {
  double power, period_m, phase_rad, amplitude_N;
};

/// Least squares of sine, cosine and a constant at one wave number, 1/m; nothing where the depths
/// do not tell them apart.
std::optional<Wave> wave_at(const std::vector<Moment>& recorded, double per_m) {
  double ss = 0, cc = 0, sc = 0, s1 = 0, c1 = 0, sr = 0, cr = 0, w = 0, r1 = 0;
  for (const auto& [depth_m, weighted, v] : recorded) {
    const double angle = 2.0 * std::numbers::pi * per_m * depth_m;
    const double s = std::sin(angle), c = std::cos(angle);
    ss += v * s * s, cc += v * c * c, sc += v * s * c, s1 += v * s, c1 += v * c, w += v;
    sr += s * weighted, cr += c * weighted, r1 += weighted;
  }
  ss -= s1 * s1 / w, cc -= c1 * c1 / w, sc -= s1 * c1 / w;
  sr -= s1 * r1 / w, cr -= c1 * r1 / w;
  const double det = ss * cc - sc * sc;
  if (!(det > 1e-9 * ss * cc)) return std::nullopt;
  const double a = (cc * sr - sc * cr) / det, b = (ss * cr - sc * sr) / det;
  return Wave{a * sr + b * cr, 1.0 / per_m, std::atan2(b, a), std::hypot(a, b)};
}

/// Lomb's periodogram of the residual over the depth, on a dense grid of wave numbers.
std::vector<Wave> periodogram(const ProbingStatistics& r) {
  const double coarsest_m = 1.5 * r.depth_range_m;
  const double finest_m = std::max(1e-4, r.depth_range_m / 400.0);
  const double step_per_m = 0.35 / r.depth_range_m;
  const auto all = moments(r);
  std::vector<Wave> out;
  for (double per_m = 1.0 / coarsest_m; per_m < 1.0 / finest_m; per_m += step_per_m)
    if (const auto wave = wave_at(all, per_m)) out.push_back(*wave);
  return out;
}

/// The three periods at which the residual has most power.
Starts starts(const ProbingStatistics& recordings) {
  const auto all = periodogram(recordings);
  std::vector<Wave> peaks;
  for (std::size_t k = 1; k + 1 < all.size(); ++k)
    if (all[k].power >= all[k - 1].power && all[k].power >= all[k + 1].power)
      peaks.push_back(all[k]);
  std::ranges::sort(peaks, std::greater<>(), &Wave::power);
  if (peaks.size() > 3) peaks.resize(3);
  Starts out;
  for (const Wave& peak : peaks) out.push_back({peak.amplitude_N, peak.period_m, peak.phase_rad});
  return out;
}

}  // namespace

ProbingEffectInfo force_ripple() {
  return {{.id = "force_ripple",
           .label = "force ripple",
           .kind = Kind::force,
           .summary = "A force that comes back with the depth, as of a lead screw",
           .equation = "A sin(2π x/p + φ)",
           .source = "own",
           .experiment = "slow strokes at two constant speeds over the same 20 mm",
           .params =
               {{.name = "amplitude_N", .meaning = "A", .initial = 0.5, .low = 0.0, .high = 100.0},
                {.name = "period_m",
                 .meaning = "p, depth after which it comes back",
                 .initial = 2e-3,
                 .low = 5e-5,
                 .high = 0.1,
                 .off = kNoOff,
                 .logarithmic = true},
                {.name = "phase_rad",
                 .meaning = "φ, phase at depth 0",
                 .initial = 0.0,
                 .low = -2.0 * std::numbers::pi,
                 .high = 2.0 * std::numbers::pi,
                 .off = kNoOff}}},
          made<ProbeForce, ForceRipple>,
          starts};
}

}  // namespace effects::probing
}  // namespace tractus
