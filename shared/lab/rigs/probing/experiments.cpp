#include "lab/rigs/probing/experiments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tractus {
namespace lab {
namespace {

using Starts = std::vector<std::vector<double>>;

constexpr int kNodes = 7;
constexpr int kPeriods = 3;

std::vector<double> between(double low, double high, int nodes) {
  std::vector<double> out;
  for (int k = 0; k < nodes; ++k)
    out.push_back(low * std::pow(high / low, (k + 0.5) / double(nodes)));
  return out;
}

/// The speed that a share of the moving samples stays under.
double speed(std::span<const ProbingRecording> trials, double share) {
  std::vector<double> all;
  for (const auto& r : trials)
    for (std::size_t k = 0; k < r.size(); k += 7)
      if (const double v = std::abs(r.motion.v_m_s[k]); v > r.motion.rest_m_s) all.push_back(v);
  if (all.empty()) return 1e-3;
  const auto at = all.begin() + std::ptrdiff_t(share * double(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

double depth_range(std::span<const ProbingRecording> trials) {
  double least = 1e9, most = -1e9;
  for (const auto& r : trials) {
    const auto [a, b] = std::ranges::minmax(r.motion.x_m);
    least = std::min(least, a);
    most = std::max(most, b);
  }
  return most - least;
}

/// The periods in depth at which the residual has most power: least squares of sine and cosine at
/// each of a dense grid (Lomb's periodogram), peaks only.
Starts ripple(std::span<const ProbingRecording> trials, const Eigen::VectorXd& residual) {
  const double range_m = depth_range(trials);
  const double coarsest = 1.5 * range_m;
  const double finest = std::max(1e-4, range_m / 400.0);
  std::vector<double> depth, weighted, weight;
  Eigen::Index at = 0;
  for (const auto& r : trials)
    for (std::size_t j = 0; j < r.measured_thin.size(); ++j, ++at) {
      depth.push_back(r.motion.x_m[r.decimator.middle(j)]);
      weighted.push_back(std::clamp(residual(at), -1e3, 1e3) / r.sd_thin[j]);
      weight.push_back(1.0 / (r.sd_thin[j] * r.sd_thin[j]));
    }
  const std::size_t stride = 1 + depth.size() / 8000;
  struct Peak {
    double power, period_m, phase_rad, amplitude;
  };
  std::vector<Peak> all;
  const double step = 0.35 / range_m;  // of the wave number in periods per metre
  for (double wave = 1.0 / coarsest; wave < 1.0 / finest; wave += step) {
    double ss = 0, cc = 0, sc = 0, s1 = 0, c1 = 0, sr = 0, cr = 0, w = 0, r1 = 0;
    for (std::size_t k = 0; k < depth.size(); k += stride) {
      const double angle = 2.0 * std::numbers::pi * wave * depth[k];
      const double s = std::sin(angle), c = std::cos(angle), v = weight[k];
      ss += v * s * s, cc += v * c * c, sc += v * s * c, s1 += v * s, c1 += v * c, w += v;
      sr += s * weighted[k], cr += c * weighted[k], r1 += weighted[k];
    }
    ss -= s1 * s1 / w, cc -= c1 * c1 / w, sc -= s1 * c1 / w;
    sr -= s1 * r1 / w, cr -= c1 * r1 / w;
    const double det = ss * cc - sc * sc;
    if (!(det > 1e-9 * ss * cc)) continue;
    const double a = (cc * sr - sc * cr) / det, b = (ss * cr - sc * sr) / det;
    all.push_back({a * sr + b * cr, 1.0 / wave, std::atan2(b, a), std::hypot(a, b)});
  }
  std::vector<Peak> peaks;
  for (std::size_t k = 1; k + 1 < all.size(); ++k)
    if (all[k].power >= all[k - 1].power && all[k].power >= all[k + 1].power)
      peaks.push_back(all[k]);
  std::ranges::sort(peaks, std::greater<>(), &Peak::power);
  Starts out;
  for (std::size_t k = 0; k < peaks.size() && k < kPeriods; ++k)
    out.push_back({peaks[k].amplitude, peaks[k].period_m, peaks[k].phase_rad});
  return out;
}

struct Advice {
  std::string_view effect, recording;
};
constexpr std::array kAdvice{
    Advice{"inertia",
           "fast strokes of 5 mm at 2 to 4 per second in one layer, and slow ones at 1 mm/s"},
    Advice{
        "coulomb_friction",
        "strokes in and out over the same depth at 1, 3 and 10 mm/s, with ten reversals or more"},
    Advice{"stribeck_friction",
           "strokes in and out at constant speeds from 0.5 to 30 mm/s, slow ones of 0.5 and 1 mm/s "
           "among them"},
    Advice{"quadratic_drag", "strokes at 2, 10, 30 and 80 mm/s over the same depth"},
    Advice{"viscoelastic_relaxation",
           "a staircase: fast steps of 5 mm, each followed by a hold of 3 to 10 s"},
    Advice{"hysteresis", "small reversals of 0.1, 0.3, 1 and 3 mm at one depth and one speed"},
    Advice{"backlash", "small reversals of 0.1 to 2 mm in two layers of different stiffness"},
    Advice{"depth_friction",
           "short strokes of 3 mm in and out, at a small depth and at a great one"},
    Advice{"rotation_coupling",
           "the same stroke while turning slowly, fast and with changing speed"},
    Advice{"force_ripple", "slow strokes at two constant speeds over the same 20 mm"},
    Advice{"sensor_bias", "five seconds in free air before and after, in the same trial"},
    Advice{"sensor_drift",
           "two long trials of 60 s of the same stroke, with free air at their ends"},
    Advice{"time_delay", "quick strokes of 3 mm at 1 to 5 per second, and a tap on something hard"},
    Advice{"torque_crosstalk",
           "turning to and fro in place, without feed, in free air and in the bone"},
    Advice{"rotary_coulomb_friction",
           "turning to and fro over the same angle at three speeds, with ten reversals or more"},
    Advice{"rotary_stiffness",
           "slow turns to and fro over 10°, 30° and 60°, with holds at each end"},
    Advice{"rotary_bias", "five seconds with nothing on the shaft, before and after"},
};

}  // namespace

Starts probing_starts(std::string_view effect, std::span<const ProbingRecording> trials,
                      const Eigen::VectorXd& residual) {
  Starts out;
  if (effect == "stribeck_friction")
    for (const double v : between(std::max(2e-4, speed(trials, 0.02)), speed(trials, 0.9), kNodes))
      out.push_back({1.0, 1.0, std::clamp(v, 1e-4, 0.2)});
  if (effect == "viscoelastic_relaxation") {
    double longest = 0.0;
    for (const auto& r : trials) longest = std::max(longest, r.seconds());
    for (const double tau : between(0.02, std::min(90.0, longest), kNodes))
      out.push_back({500.0, tau});
  }
  if (effect == "hysteresis")
    for (const double d : between(1e-5, std::min(0.02, 0.5 * depth_range(trials)), kNodes))
      out.push_back({1.0 / d, std::clamp(d, 1e-6, 0.02)});
  if (effect == "force_ripple") out = ripple(trials, residual);
  if (effect == "backlash")  // the play interrupts the damping, or it does not
    for (const double gap_m : {1e-4, 1e-3}) {
      out.push_back({gap_m, 0.0});
      out.push_back({gap_m, 1.0});
    }
  return out;
}

std::string probing_recording(std::string_view a, std::string_view b) {
  const auto of = [](std::string_view id) -> std::string {
    for (const Advice& advice : kAdvice)
      if (advice.effect == id) return std::string(advice.recording);
    return "strokes in and out at three speeds, with holds and reversals, over the whole depth";
  };
  if (b.empty() || of(a) == of(b)) return of(a);
  return of(a) + "; then " + of(b);
}

}  // namespace lab
}  // namespace tractus
