#include "lab/palpation_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/smoother.hpp"

namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using math::Vec3;

constexpr std::size_t kFewestSamples = 60;
constexpr double kSlowestRate_Hz = 40.0;
constexpr double kThinRate_Hz = 100.0;
/// A sample whose expected error exceeds the sensor's by this factor is not trusted at the full
/// rate.
constexpr double kPoorlyKnown = 10.0;
constexpr double kContact_N = 0.05;
/// A pressed point, and how many standard errors of its speed have a sign.
constexpr double kPressed_N = 0.3, kSignErrors = 3.0;
/// The shank has snapped when the tip went by more than this beyond what the hand explains; the
/// moment is known to so many samples.
constexpr double kSnapRatio = 2.0, kSnap_m = 3e-5;
constexpr std::size_t kSnapSamples = 4;
constexpr double kPlaceStep_m = 2e-6, kTurnStep_rad = 2e-5;

/// Standard deviation of the white noise on a smooth signal: from sixth differences, median over
/// short stretches, so that impacts do not count; at least what rounding to even steps makes.
/// Neighbouring differences share samples, which leaves a stretch's mean square as many degrees of
/// freedom as it has samples by Σρ² = 3.17; its median lies below its mean by (1 − 2/9ν)³
/// [Wilson and Hilferty].
double noise_of(const std::vector<double>& y) {
  constexpr std::size_t kWindow = 48, kOrder = 6;
  constexpr double kCoefficients[kOrder + 1] = {1, -6, 15, -20, 15, -6, 1};
  constexpr double kSquares = 924.0, kFreedom = double(kWindow) / 3.17;
  std::vector<double> squares;
  double least = HUGE_VAL;
  for (std::size_t k = 1; k < y.size(); ++k)
    if (const double step = std::abs(y[k] - y[k - 1]); step > 0.0) least = std::min(least, step);
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
  const double rounding = std::isfinite(least) ? least / std::sqrt(12.0) : 0.0;
  const double below = std::pow(1.0 - 2.0 / (9.0 * kFreedom), 3);
  return std::max(
      {std::sqrt(*middle / below), std::min(rounding, 1e-4 * most), 1e-9 * most, 1e-12});
}

/// Position and orientation through the smoother, channel by channel; the quaternion's four
/// numbers, continuous in sign, and normalised after.
void smooth_poses(const trial::PalpationMeasurement& trial, const Vec3& down,
                  PalpationRecording& out) {
  const std::size_t n = trial.t_s.size();
  std::array<std::vector<double>, 7> columns;
  math::Quat last = math::Quat::Identity();
  for (const math::Pose& pose : trial.X_VH) {
    math::Quat q = pose.q.normalized();
    if (q.dot(last) < 0.0) q.coeffs() = -q.coeffs();
    last = q;
    const double values[] = {pose.p.x(), pose.p.y(), pose.p.z(), q.w(), q.x(), q.y(), q.z()};
    for (std::size_t c = 0; c < 7; ++c) columns[c].push_back(values[c]);
  }
  std::array<Smoothed, 7> s;
  for (std::size_t c = 0; c < 7; ++c) s[c] = smooth(trial.t_s, columns[c], noise_of(columns[c]));
  out.motion.t_s = trial.t_s;
  out.motion.handle.resize(n);
  out.p_sd_m.resize(n);
  out.turn_sd_rad.resize(n);
  out.v_sd_m_s.resize(n);
  out.omega_sd_rad_s.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto three = [&](auto member) -> Vec3 {
      return {(s[0].*member)[k], (s[1].*member)[k], (s[2].*member)[k]};
    };
    const auto four = [&](auto member) -> math::Quat {
      return {(s[3].*member)[k], (s[4].*member)[k], (s[5].*member)[k], (s[6].*member)[k]};
    };
    const math::Quat q = four(&Smoothed::value), dq = four(&Smoothed::rate),
                     ddq = four(&Smoothed::acceleration);
    const double n2 = q.squaredNorm();
    effects::HandleMotion& handle = out.motion.handle[k];
    handle.X_VH = {three(&Smoothed::value), q.normalized()};
    handle.v_m_s = three(&Smoothed::rate);
    handle.a_m_s2 = three(&Smoothed::acceleration);
    handle.omega_rad_s = 2.0 * (dq * q.conjugate()).vec() / n2;
    handle.alpha_rad_s2 =
        2.0 * (ddq * q.conjugate()).vec() / n2 - handle.omega_rad_s * (2.0 * q.dot(dq) / n2);
    handle.down = down;
    out.p_sd_m[k] = three(&Smoothed::value_sd);
    const auto typical = [&](auto member, std::size_t from, std::size_t end) {
      double squares = 0.0;
      for (std::size_t c = from; c < end; ++c) squares += (s[c].*member)[k] * (s[c].*member)[k];
      return std::sqrt(squares / double(end - from));
    };
    out.turn_sd_rad[k] = 2.0 * typical(&Smoothed::value_sd, 3, 7);
    out.v_sd_m_s[k] = typical(&Smoothed::rate_sd, 0, 3);
    out.omega_sd_rad_s[k] = 2.0 * typical(&Smoothed::rate_sd, 3, 7);
  }
}

/// The motion moved as a whole: along axis 0 … 2 of V, or turned about axis 3 … 5 at the handle.
models::PalpationMotion moved(const models::PalpationMotion& motion, int way, double step) {
  models::PalpationMotion out = motion;
  const Vec3 axis = Vec3::Unit(way % 3);
  const math::Quat turn(Eigen::AngleAxisd(step, axis));
  for (effects::HandleMotion& handle : out.handle) {
    if (way < 3)
      handle.X_VH.p += step * axis;
    else
      handle.X_VH.q = turn * handle.X_VH.q;
  }
  return out;
}

/// Covariance of each sample's wrench by the pose's error.
std::vector<Mat6> motion_covariance(const models::PalpationRuntime& runtime,
                                    const PalpationRecording& r,
                                    const models::PalpationAnswer& at) {
  const std::size_t n = r.size();
  std::vector<Mat6> out(n, Mat6::Zero());
  models::PalpationAnswer there;
  for (int way = 0; way < 6; ++way) {
    const double step = way < 3 ? kPlaceStep_m : kTurnStep_rad;
    predict(runtime, r, moved(r.motion, way, step), there);
    for (std::size_t k = 0; k < n; ++k) {
      const double sd = way < 3 ? r.p_sd_m[k][way] : r.turn_sd_rad[k];
      const Vec6 error = (stacked(there.wrench_H[k]) - stacked(at.wrench_H[k])) * (sd / step);
      out[k] += error * error.transpose();
    }
  }
  return out;
}

/// Where the unbent tip is, and how fast.
struct Tip {
  Vec3 p_m, v_m_s;
};
Tip unbent_tip(const models::PalpationRuntime& runtime, const effects::HandleMotion& handle) {
  const Vec3 lever = runtime.law().parameters().length_m * (handle.X_VH.q * Vec3::UnitZ());
  return {handle.X_VH.p + lever, handle.v_m_s + handle.omega_rad_s.cross(lever)};
}

/// Samples at which the shank has gone to another rest: it moved by far more than the hand.
std::vector<std::size_t> snaps(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                               const models::PalpationAnswer& at) {
  std::vector<std::size_t> out;
  for (std::size_t k = 1; k < r.size(); ++k) {
    const double by_hand = (unbent_tip(runtime, r.motion.handle[k]).p_m -
                            unbent_tip(runtime, r.motion.handle[k - 1]).p_m)
                               .norm();
    if ((at.deflection_m[k] - at.deflection_m[k - 1]).norm() > kSnapRatio * by_hand + kSnap_m)
      out.push_back(k);
  }
  return out;
}

/// Does a pressed point move so slowly along or across its force that the sign is not known?
bool sign_unknown(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                  const models::PalpationAnswer& at, std::size_t k) {
  const double force_N = at.wrench_H[k].force_N.norm();
  if (force_N < kPressed_N) return false;
  const Vec3 n = r.motion.handle[k].X_VH.q * at.wrench_H[k].force_N / force_N;
  const Vec3 v = unbent_tip(runtime, r.motion.handle[k]).v_m_s;
  const double along = std::abs(v.dot(n)), across = (v - v.dot(n) * n).norm();
  const double sd =
      std::hypot(r.v_sd_m_s[k], runtime.law().parameters().length_m * r.omega_sd_rad_s[k]);
  return std::min(along, across) < kSignErrors * sd;
}

/// Trusted samples, the floor over them, and |g| where the tip touches.
void set_trust(const models::PalpationRuntime& runtime, PalpationRecording& r,
               const models::PalpationAnswer& at, const std::vector<Mat6>& by_motion,
               const std::vector<std::size_t>& snapped) {
  const Vec6 sensor = r.noise_sd.cwiseAbs2();
  const double most = kPoorlyKnown * kPoorlyKnown * sensor.head<3>().sum();
  for (std::size_t k = 0; k < r.size(); ++k)
    r.trusted[k] = at.converged[k] && by_motion[k].topLeftCorner<3, 3>().trace() <= most &&
                           !sign_unknown(runtime, r, at, k)
                       ? 1.0
                       : 0.0;
  for (const std::size_t k : snapped)
    for (std::size_t i = k - std::min(k, kSnapSamples); i < std::min(r.size(), k + kSnapSamples);
         ++i)
      r.trusted[i] = 0.0;
  r.floor.setZero();
  r.field_per_m.clear();
  double trusted = 0.0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (r.trusted[k] > 0.0) {
      r.floor += sensor + Vec6(by_motion[k].diagonal());
      trusted += 1.0;
    }
    if (at.wrench_H[k].force_N.norm() < kContact_N) continue;
    const Vec3 tip = runtime.tip_m(r.motion.handle[k].X_VH, at.deflection_m[k]);
    r.field_per_m.push_back(runtime.field().gradient_per_m(tip).norm());
  }
  r.floor = trusted > 0.0 ? Vec6((r.floor / trusted).cwiseSqrt()) : r.noise_sd;
}

Error wrong(const std::string& where, const std::string& why) {
  return {Errc::bad_input, fmt::format("{}: {}", where, why)};
}

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> PalpationRecording::thinned(
    const std::vector<math::Wrench>& wrench_H) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic> out(6, Eigen::Index(decimator.size(wrench_H.size())));
  std::vector<double> in(wrench_H.size()), thin(std::size_t(out.cols()));
  for (int c = 0; c < 6; ++c) {
    for (std::size_t k = 0; k < in.size(); ++k)
      in[k] = c < 3 ? wrench_H[k].force_N[c] : wrench_H[k].torque_Nm[c - 3];
    decimator.apply(in, thin);
    out.row(c) = Eigen::Map<const Eigen::RowVectorXd>(thin.data(), out.cols());
  }
  return out;
}

Result<PalpationRecording> prepare(trial::PalpationMeasurement&& trial, const Vec3& down,
                                   const std::string& where) {
  const std::size_t n = trial.t_s.size();
  if (n < kFewestSamples)
    return wrong(where, fmt::format("{} samples, at least {} are expected", n, kFewestSamples));
  const double spacing_s = (trial.t_s.back() - trial.t_s.front()) / double(n - 1);
  if (spacing_s * kSlowestRate_Hz > 1.001)
    return wrong(where, fmt::format("{:.3g} samples per second, at least {} are expected",
                                    1.0 / spacing_s, kSlowestRate_Hz));
  PalpationRecording out;
  out.id = trial.id;
  smooth_poses(trial, down, out);
  out.decimator = Decimator(spacing_s, kThinRate_Hz);
  for (const math::Wrench& wrench : trial.wrench_H) out.measured.push_back(stacked(wrench));
  std::vector<double> column(n);
  for (int c = 0; c < 6; ++c) {
    for (std::size_t k = 0; k < n; ++k) column[k] = out.measured[k][c];
    out.noise_sd[c] = noise_of(column);
  }
  out.slow_noise_sd = out.noise_sd * std::sqrt(out.decimator.noise_gain());
  out.measured_thin = out.thinned(trial.wrench_H);
  out.whitener.assign(std::size_t(out.outputs()), Mat6::Identity());
  out.trusted.assign(n, 1.0);
  return out;
}

void predict(const models::PalpationRuntime& runtime, const PalpationRecording& recording,
             const models::PalpationMotion& motion, models::PalpationAnswer& out) {
  runtime.predict(motion, out, recording.deflection_m);
}

void weigh(const models::PalpationRuntime& runtime, PalpationRecording& r) {
  models::PalpationAnswer at;
  runtime.predict(r.motion, at);
  r.deflection_m = at.deflection_m;
  const auto by_motion = motion_covariance(runtime, r, at);
  const auto snapped = snaps(runtime, r, at);
  set_trust(runtime, r, at, by_motion, snapped);
  const Vec6 slow = r.slow_noise_sd.cwiseAbs2();
  const std::size_t reach = r.decimator.half() + kSnapSamples;
  for (std::size_t j = 0; j < r.whitener.size(); ++j) {
    const std::size_t middle = r.decimator.middle(j);
    Mat6 expected = by_motion[middle];
    expected.diagonal() += slow;
    for (const std::size_t k : snapped)
      if (k + reach >= middle && k <= middle + reach) {
        const Vec6 jump = stacked(at.wrench_H[k]) - stacked(at.wrench_H[k - 1]);
        expected += jump * jump.transpose();
      }
    const Eigen::LLT<Mat6> root(expected);
    r.whitener[j] = root.matrixL().solve(Mat6::Identity());
  }
}

}  // namespace lab
