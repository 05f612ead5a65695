#include "lab/rigs/palpation/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lab/settings.hpp"
#include "lab/signal/saturation.hpp"
#include "lab/signal/smoother.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using math::Vec3;

constexpr const char* kChannels[] = {"fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"};
constexpr const auto& kPalpationRecording = kSettings.palpation_recording;
/// The step that a channel's values were rounded to, 0 if they were not: all lie on a grid of it.
double rounding_step(const std::vector<double>& y, double most) {
  double least = HUGE_VAL;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (const double step = std::abs(y[k] - y[k - 1]); step > 1e-9 * most)
      least = std::min(least, step);
  if (!std::isfinite(least)) return 0.0;
  for (const double v : y)
    if (std::abs(std::remainder(v - y[0], least)) > 0.01 * least) return 0.0;
  return least;
}

/// Standard deviation of the white noise on a smooth signal: from sixth differences, median over
/// short stretches, so that impacts do not count; at least what rounding to even steps makes of a
/// sensor whose own noise is less (kRounded: a little of that noise comes on top).
/// Neighbouring differences share samples, which leaves a stretch's mean square as many degrees of
/// freedom as it has samples by Σρ² = 3.17; its median lies below its mean by (1 − 2/9ν)³
/// [Wilson and Hilferty].
double noise_of(const std::vector<double>& y) {
  constexpr std::size_t kWindow = 48, kOrder = 6;
  constexpr double kCoefficients[kOrder + 1] = {1, -6, 15, -20, 15, -6, 1};
  constexpr double kSquares = 924.0, kFreedom = double(kWindow) / 3.17, kRounded = 1.15;
  std::vector<double> squares;
  for (std::size_t at = 0; at + kWindow + kOrder <= y.size(); at += kWindow) {
    double sum = 0.0;
    for (std::size_t k = at; k < at + kWindow; ++k) {
      double d = 0.0;
      for (std::size_t i = 0; i <= kOrder; ++i) d += kCoefficients[i] * y[k + i];
      sum += d * d;
    }
    squares.push_back(sum / double(kWindow) / kSquares);
  }
  const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
  std::ranges::nth_element(squares, middle);
  double most = 0.0;
  for (const double v : y) most = std::max(most, std::abs(v));
  const double below = std::pow(1.0 - 2.0 / (9.0 * kFreedom), 3);
  return std::max({std::sqrt(*middle / below), kRounded * rounding_step(y, most) / std::sqrt(12.0),
                   1e-9 * most, 1e-12});
}

/// Linear between the samples, the nearest one's beyond them.
double between(const std::vector<double>& t_s, const std::vector<double>& y, double at_s) {
  const auto after = std::size_t(std::ranges::upper_bound(t_s, at_s) - t_s.begin());
  if (after == 0 || after == t_s.size()) return y[after == 0 ? 0 : after - 1];
  const double share = (at_s - t_s[after - 1]) / (t_s[after] - t_s[after - 1]);
  return y[after - 1] + share * (y[after] - y[after - 1]);
}

/// Means of so many samples each, in turn.
std::vector<double> means_of(const std::vector<double>& y, std::size_t each) {
  std::vector<double> out;
  for (std::size_t k = 0; k + each <= y.size(); k += each)
    out.push_back(
        std::accumulate(y.begin() + std::ptrdiff_t(k), y.begin() + std::ptrdiff_t(k + each), 0.0) /
        double(each));
  return out;
}

/// Every so many-th of a smoothed channel.
struct Kept {
  std::vector<double> value, rate, acceleration, value_sd, rate_sd, acceleration_sd;
};

/// The acceleration once more, from means: a tracker filters, and white noise as small as neighbouring samples tell lets
/// the smoother take the rest of the tracker's noise for motion. The mass of a probe was then drowned in it.
void set_acceleration(const std::vector<double>& t_s, const std::vector<double>& y,
                      std::size_t stride, Kept& out) {
  const double spacing_s = (t_s.back() - t_s.front()) / double(t_s.size() - 1);
  const auto each =
      std::size_t(std::lround(kPalpationRecording.acceleration_of_means_s / spacing_s));
  if (each < 2 || y.size() < kPalpationRecording.fewest_samples * each) return;
  const std::vector<double> mean_t_s = means_of(t_s, each), mean = means_of(y, each);
  const Smoothed slow = smooth(mean_t_s, mean, noise_of(mean));
  for (std::size_t k = 0; k < out.value.size(); ++k) {
    const double at_s = t_s[k * stride];
    out.acceleration[k] = between(mean_t_s, slow.acceleration, at_s);
    out.acceleration_sd[k] = between(mean_t_s, slow.acceleration_sd, at_s);
  }
}

Kept kept(const std::vector<double>& t_s, const std::vector<double>& y, std::size_t stride) {
  const Smoothed s = smooth(t_s, y, noise_of(y));
  Kept out;
  for (std::size_t k = 0; k < y.size(); k += stride) {
    out.value.push_back(s.value[k]);
    out.rate.push_back(s.rate[k]);
    out.acceleration.push_back(s.acceleration[k]);
    out.value_sd.push_back(s.value_sd[k]);
    out.rate_sd.push_back(s.rate_sd[k]);
    out.acceleration_sd.push_back(s.acceleration_sd[k]);
  }
  set_acceleration(t_s, y, stride, out);
  return out;
}

/// Position and orientation through the smoother, channel by channel; the quaternion's four
/// numbers, continuous in sign, and normalised after.
std::array<Kept, 7> smooth_channels(const trial::PalpationMeasurement& trial, std::size_t stride) {
  std::array<Kept, 7> out;
  std::vector<double> column(trial.t_s.size());
  for (std::size_t c = 0; c < 7; ++c) {
    math::Quat last = math::Quat::Identity();
    for (std::size_t k = 0; k < column.size(); ++k) {
      const math::Pose& pose = trial.X_VH[k];
      math::Quat q = pose.q.normalized();
      if (q.dot(last) < 0.0) q.coeffs() = -q.coeffs();
      last = q;
      const double values[] = {pose.p.x(), pose.p.y(), pose.p.z(), q.w(), q.x(), q.y(), q.z()};
      column[k] = values[c];
    }
    out[c] = kept(trial.t_s, column, stride);
  }
  return out;
}

void smooth_poses(const trial::PalpationMeasurement& trial, const Vec3& down, std::size_t stride,
                  PalpationRecording& out) {
  const auto s = smooth_channels(trial, stride);
  const std::size_t n = s[0].value.size();
  for (std::size_t k = 0; k < trial.t_s.size(); k += stride) out.motion.t_s.push_back(trial.t_s[k]);
  out.motion.handle.resize(n);
  out.p_sd_m.resize(n);
  out.turn_sd_rad.resize(n);
  out.v_sd_m_s.resize(n);
  out.omega_sd_rad_s.resize(n);
  out.a_sd_m_s2.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto three = [&](auto member) -> Vec3 {
      return {(s[0].*member)[k], (s[1].*member)[k], (s[2].*member)[k]};
    };
    const auto four = [&](auto member) -> math::Quat {
      return {(s[3].*member)[k], (s[4].*member)[k], (s[5].*member)[k], (s[6].*member)[k]};
    };
    const math::Quat q = four(&Kept::value), dq = four(&Kept::rate),
                     ddq = four(&Kept::acceleration);
    const double n2 = q.squaredNorm();
    effects::HandleMotion& handle = out.motion.handle[k];
    handle.X_VH = {three(&Kept::value), q.normalized()};
    handle.v_m_s = three(&Kept::rate);
    handle.a_m_s2 = three(&Kept::acceleration);
    handle.omega_rad_s = 2.0 * (dq * q.conjugate()).vec() / n2;
    handle.alpha_rad_s2 =
        2.0 * (ddq * q.conjugate()).vec() / n2 - handle.omega_rad_s * (2.0 * q.dot(dq) / n2);
    handle.down = down;
    out.p_sd_m[k] = three(&Kept::value_sd);
    const auto typical = [&](auto member, std::size_t from, std::size_t end) {
      double squares = 0.0;
      for (std::size_t c = from; c < end; ++c) squares += (s[c].*member)[k] * (s[c].*member)[k];
      return std::sqrt(squares / double(end - from));
    };
    out.turn_sd_rad[k] = 2.0 * typical(&Kept::value_sd, 3, 7);
    out.v_sd_m_s[k] = typical(&Kept::rate_sd, 0, 3);
    out.a_sd_m_s2[k] = typical(&Kept::acceleration_sd, 0, 3);
    out.omega_sd_rad_s[k] = 2.0 * typical(&Kept::rate_sd, 3, 7);
  }
}

/// Cuts a trial to the stretch of so many samples in which the force is most unsteady.
void cut(trial::PalpationMeasurement& trial, std::size_t most) {
  const std::size_t n = trial.t_s.size();
  Vec3 mean = Vec3::Zero();
  for (const math::Wrench& w : trial.wrench_H) mean += w.force_N / double(n);
  const auto square = [&](std::size_t k) {
    return (trial.wrench_H[k].force_N - mean).squaredNorm();
  };
  double sum = 0.0;
  for (std::size_t k = 0; k < most; ++k) sum += square(k);
  double best = sum;
  std::size_t from = 0;
  for (std::size_t k = most; k < n; ++k) {
    sum += square(k) - square(k - most);
    if (sum > best) best = sum, from = k - most + 1;
  }
  const auto keep = [&](auto& column) {
    column.erase(column.begin(), column.begin() + std::ptrdiff_t(from));
    column.resize(most);
    column.shrink_to_fit();
  };
  keep(trial.t_s), keep(trial.X_VH), keep(trial.wrench_H);
}

Error unusable_palpation(const std::string& where, const std::string& why) {
  return {Errc::bad_input, fmt::format("{}: {}", where, why)};
}

}  // namespace

std::vector<std::size_t> PalpationRecording::all() const {
  std::vector<std::size_t> out(size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = k;
  return out;
}

Result<PalpationRecording> prepare(trial::PalpationMeasurement&& trial, const Vec3& down,
                                   const std::string& where, std::size_t most_samples) {
  PalpationRecording out;
  const std::size_t recorded = trial.t_s.size();
  if (recorded < kPalpationRecording.fewest_samples)
    return unusable_palpation(where, fmt::format("{} samples, at least {} are expected", recorded,
                                                 kPalpationRecording.fewest_samples));
  if (recorded > most_samples) {
    cut(trial, most_samples);
    out.note = fmt::format(
        "{}: {} samples are more than needed; the {} s from {:.1f} s on, where the "
        "force changes most, were compared",
        trial.id, recorded, std::lround(trial.t_s.back() - trial.t_s.front()), trial.t_s.front());
  }
  const std::size_t n = trial.t_s.size();
  const double spacing_s = (trial.t_s.back() - trial.t_s.front()) / double(n - 1);
  if (spacing_s * kPalpationRecording.slowest_rate_Hz > 1.001)
    return unusable_palpation(
        where, fmt::format("{:.3g} samples per second, at least {} are expected", 1.0 / spacing_s,
                           kPalpationRecording.slowest_rate_Hz));
  out.id = trial.id;
  const auto stride =
      std::size_t(std::max(1.0, std::ceil(0.999 / (spacing_s * kPalpationRecording.fastest_Hz))));
  smooth_poses(trial, down, stride, out);
  std::vector<double> column(n);
  for (int c = 0; c < 6; ++c) {
    for (std::size_t k = 0; k < n; ++k) column[k] = stacked(trial.wrench_H[k])[c];
    const auto [least, most] = std::ranges::minmax(column);
    out.noise_sd[c] = least < most ? noise_of(column) : PalpationRecording::kDead;
    if (!(least < most))
      out.note += fmt::format("{}{}: {} never changes and was not compared",
                              out.note.empty() ? "" : "; ", trial.id, kChannels[c]);
  }
  for (std::size_t k = 0; k < n; k += stride) out.measured.push_back(stacked(trial.wrench_H[k]));
  out.judgement.assign(out.size(), Judgement::judged);
  out.saturated.assign(out.size(), {});
  choose_instants(out, 1);
  return out;
}

void mark_saturated(std::span<PalpationRecording> recordings) {
  for (PalpationRecording& r : recordings) r.saturated.assign(r.size(), {});
  for (int c = 0; c < 6; ++c) {
    std::vector<std::vector<double>> columns;
    for (const PalpationRecording& r : recordings) {
      columns.emplace_back();
      for (const Vec6& wrench : r.measured) columns.back().push_back(wrench[c]);
    }
    std::vector<std::span<const double>> telling;
    for (std::size_t k = 0; k < recordings.size(); ++k)
      if (shows_noise(columns[k], recordings[k].noise_sd[c])) telling.emplace_back(columns[k]);
    const SensorRange range = sensor_range(telling);
    for (PalpationRecording& r : recordings)
      for (std::size_t k = 0; k < r.size(); ++k)
        r.saturated[k][std::size_t(c)] = range.ends_at(r.measured[k][c]);
  }
}

void choose_instants(PalpationRecording& r, std::size_t stride) {
  r.instants.clear();
  for (std::size_t k = stride / 2; k < r.size(); k += stride) r.instants.push_back(k);
  r.whitener.assign(r.instants.size(), Mat6::Identity());
}

}  // namespace lab
}  // namespace tractus
