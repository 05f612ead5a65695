#include "support/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/angle.hpp"

namespace blind {
namespace {

double minimum_jerk(double u) { return u * u * u * (10.0 + u * (-15.0 + 6.0 * u)); }

/// Speed rises over the first fifth as a raised cosine, stays, falls over the last.
double ramp(double u) {
  constexpr double kEdge = 0.2;
  const auto rise = [](double s) {
    return 0.5 * (s - kEdge / std::numbers::pi * std::sin(std::numbers::pi * s / kEdge));
  };
  const double full = 1.0 - kEdge;  // area under the speed
  if (u < kEdge) return rise(u) / full;
  if (u > 1.0 - kEdge) return 1.0 - rise(1.0 - u) / full;
  return (0.5 * kEdge + (u - kEdge)) / full;
}

}  // namespace

void Path::stroke(double to, double duration_s, Stroke shape) {
  pieces_.push_back({end_s_, duration_s, last_, to, shape});
  end_s_ += duration_s;
  last_ = to;
}

double Path::at(double t_s) const {
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), t_s,
                                     [](double t, const Piece& p) { return t < p.begin_s; });
  if (next == pieces_.begin()) return start_;
  const Piece& piece = *std::prev(next);
  const double u = std::min(1.0, (t_s - piece.begin_s) / piece.duration_s);
  const double share = piece.shape == Stroke::kMinimumJerk ? minimum_jerk(u) : ramp(u);
  return piece.from + share * (piece.to - piece.from);
}

Path probing_path(Random& random, double low_m, double high_m, double duration_s, Stroke shape) {
  const double span = high_m - low_m;
  Path path(low_m + span * random.uniform(0.0, 0.3));
  path.hold(random.uniform(0.05, 0.3));
  while (path.end_s() < duration_s) {
    const double choice = random.unit();
    if (choice < 0.25) {
      path.hold(random.uniform(0.2, 1.2));
      continue;
    }
    const double small = random.uniform(3e-4, 1.5e-3) * random.sign();
    // Early strokes tend inward, later ones anywhere: a person feels the way forward.
    const double deep = std::min(1.0, 0.3 + path.end_s() / duration_s);
    double to = choice < 0.5 ? path.last() + small : low_m + span * deep * random.unit();
    if (random.chance(0.25)) to = random.chance(0.7) ? high_m : low_m;
    to = std::clamp(to, low_m, high_m);
    const double speed = random.log_uniform(1.5e-3, 2.2e-2);
    const double duration = std::clamp(std::abs(to - path.last()) / speed, 0.12, 3.0);
    path.stroke(to, duration, shape);
  }
  return path;
}

Path turning_path(Random& random, double duration_s) {
  Path path(0.0);
  double way = random.sign();
  while (path.end_s() < duration_s) {
    if (random.chance(0.3)) path.hold(random.uniform(0.3, 1.2));
    const double speed =
        random.chance(0.5) ? random.log_uniform(0.3, 1.5) : random.log_uniform(1.5, 6.0);
    const double duration = random.uniform(0.3, 1.5);
    path.stroke(path.last() + way * speed * duration, duration, Stroke::kRamp);
    if (random.chance(0.6)) way = -way;
  }
  return path;
}

void MultiSine::add(double amplitude, double frequency_Hz, double phase_rad) {
  sines_.push_back({amplitude, kTwoPi * frequency_Hz, phase_rad});
}

double MultiSine::at(double t_s) const {
  double sum = 0;
  for (const Sine& s : sines_) sum += s.amplitude * std::sin(s.rate_rad_s * t_s + s.phase_rad);
  const double u = std::min(1.0, t_s / 0.5);
  return sum * minimum_jerk(u);
}

MultiSine tremor(Random& random, double amplitude) {
  MultiSine out;
  constexpr int kLines = 5;
  for (int i = 0; i < kLines; ++i)
    out.add(amplitude * std::sqrt(2.0 / kLines), random.uniform(8.0, 10.0),
            random.uniform(0, kTwoPi));
  return out;
}

}  // namespace blind
