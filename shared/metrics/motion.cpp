#include "metrics/motion.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "math/savitzky_golay.hpp"

namespace tractus {
namespace metrics {
namespace {

constexpr double kSpeedRounding =
    1e-9;  // of a speed: what differentiating leaves of a constant one
constexpr double kCutoff_Hz = 10.0, kLeastShare = 0.05;
constexpr std::size_t kSegment = 256;

std::vector<double> magnitudes(std::span<const double> values, std::size_t padded) {
  std::vector<double> in(values.begin(), values.end());
  in.resize(padded, 0.0);
  std::vector<std::complex<double>> out;
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.fwd(out, in);
  std::vector<double> size;
  for (const auto& value : out) size.push_back(std::abs(value));
  return size;
}

/// Welch's window: 1 in the middle, 0 at the first sample, periodic.
std::vector<double> hann() {
  std::vector<double> out;
  for (std::size_t i = 0; i < kSegment; ++i)
    out.push_back(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * double(i) / double(kSegment)));
  return out;
}

}  // namespace

std::optional<double> spectral_arc_length(std::span<const double> speed, double rate_Hz) {
  if (speed.size() < 3) return std::nullopt;
  const auto power = std::size_t(std::ceil(std::log2(double(speed.size())))) + 4;
  const std::size_t padded = std::size_t{1} << power;
  auto spectrum = magnitudes(speed, padded);
  const double top = std::ranges::max(spectrum);
  if (!(top > 0.0)) return std::nullopt;
  const double step_Hz = rate_Hz / double(padded);
  const auto within = std::size_t(std::floor(kCutoff_Hz / step_Hz)) + 1;
  if (within < spectrum.size()) spectrum.resize(within);
  for (double& value : spectrum) value /= top;
  const auto counts = [](double value) { return value >= kLeastShare; };
  const auto first = std::ranges::find_if(spectrum, counts);
  const auto last = std::find_if(spectrum.rbegin(), spectrum.rend(), counts).base();
  if (last - first < 2) return std::nullopt;
  const double step = 1.0 / double(last - first - 1);
  double length = 0.0;
  for (auto at = first + 1; at != last; ++at) length += std::hypot(step, *at - *(at - 1));
  return -length;
}

std::optional<double> log_dimensionless_jerk(std::span<const double> speed, double rate_Hz) {
  if (speed.size() < 3) return std::nullopt;
  const double peak = std::ranges::max(speed), dt = 1.0 / rate_Hz;
  const double duration = double(speed.size()) * dt;
  double sum = 0.0;
  for (std::size_t i = 2; i < speed.size(); ++i) {
    const double jerk = (speed[i] - 2.0 * speed[i - 1] + speed[i - 2]) / (dt * dt);
    sum += jerk * jerk * dt;
  }
  if (!(peak > 0.0) || !(sum > 0.0)) return std::nullopt;
  return -std::log(duration * duration * duration / (peak * peak) * sum);
}

int speed_peaks(std::span<const double> speed, double floor) {
  int count = 0;
  for (std::size_t i = 1; i + 1 < speed.size(); ++i) {
    const double rounding = kSpeedRounding * speed[i];
    if (speed[i] >= floor && speed[i] > speed[i - 1] + rounding &&
        speed[i] >= speed[i + 1] - rounding)
      ++count;
  }
  return count;
}

std::optional<double> band_power(std::span<const double> values, double rate_Hz, double low_Hz,
                                 double high_Hz) {
  if (values.size() < kSegment) return std::nullopt;
  const auto window = hann();
  double scale = 0.0;
  for (const double w : window) scale += w * w;
  const double step_Hz = rate_Hz / double(kSegment);
  double power = 0.0;
  int segments = 0;
  for (std::size_t from = 0; from + kSegment <= values.size(); from += kSegment / 2, ++segments) {
    double mean = 0.0;
    for (std::size_t i = 0; i < kSegment; ++i) mean += values[from + i] / double(kSegment);
    std::vector<double> segment;
    for (std::size_t i = 0; i < kSegment; ++i)
      segment.push_back(window[i] * (values[from + i] - mean));
    const auto spectrum = magnitudes(segment, kSegment);
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
      const double f = double(k) * step_Hz;
      if (f < low_Hz || f > high_Hz) continue;
      const double sides = k + 1 == spectrum.size() ? 1.0 : 2.0;
      power += sides * spectrum[k] * spectrum[k] / (rate_Hz * scale) * step_Hz;
    }
  }
  return power / segments;
}

double Kinematics::motion_smoothness() const {
  return std::sqrt(0.5 * jerk2_m2_s5 * std::pow(duration_s, 5) / (path_m * path_m));
}

std::optional<Kinematics> kinematics(std::span<const math::Vec3> points_m, double dt_s) {
  const math::SavitzkyGolay slope(21, 3, 1), third(41, 5, 3);
  if (points_m.size() < std::size_t(third.window())) return std::nullopt;
  std::vector<double> speed2(points_m.size(), 0.0), jerk2 = speed2, coordinate = speed2;
  for (int axis = 0; axis < 3; ++axis) {
    // From the first point: one that rests has a speed of 0, not of rounding.
    for (std::size_t i = 0; i < points_m.size(); ++i)
      coordinate[i] = points_m[i][axis] - points_m[0][axis];
    const auto v = slope.apply(coordinate, dt_s), j = third.apply(coordinate, dt_s);
    for (std::size_t i = 0; i < v.size(); ++i) {
      speed2[i] += v[i] * v[i];
      jerk2[i] += j[i] * j[i];
    }
  }
  Kinematics out;
  for (const double square : speed2) out.speed_m_s.push_back(std::sqrt(square));
  for (std::size_t i = 1; i < points_m.size(); ++i)
    out.path_m += 0.5 * dt_s * (out.speed_m_s[i - 1] + out.speed_m_s[i]);
  for (const double square : jerk2) out.jerk2_m2_s5 += dt_s * square;
  out.straight_m = (points_m.back() - points_m.front()).norm();
  out.duration_s = double(points_m.size() - 1) * dt_s;
  return out;
}

double integral(std::span<const double> x, std::span<const double> y) {
  double sum = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += 0.5 * (x[i] - x[i - 1]) * (y[i] + y[i - 1]);
  return sum;
}

}  // namespace metrics
}  // namespace tractus
