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
/// Faster recordings are thinned to no more than this after smoothing.
constexpr double kFastest_Hz = 250.0;
/// A sample whose expected error exceeds the sensor's by this factor is not trusted.
constexpr double kPoorlyKnown = 10.0;
constexpr double kContact_N = 0.05;
/// A pressed point, and how many standard errors of its speed have a sign.
constexpr double kPressed_N = 0.3, kSignErrors = 3.0;
/// Friction and losses are thought of as this share of the contact force.
constexpr double kRubbing = 0.1;
/// A probe's inertia is thought of as that of this mass.
constexpr double kMass_kg = 0.1;
constexpr double kEdge_voxels = 2.0;
/// The shank has snapped when the tip went by more than this beyond what the hand explains; the
/// moment is known to this.
constexpr double kSnapRatio = 2.0, kSnap_m = 3e-5;
constexpr double kSnapKnown_s = 0.015;
/// Rests nearer than this are one; what a change of rest must save, in squares of the usual error,
/// of which a sample counts no more than so many.
constexpr double kSameRest_m = 2e-6, kChange = 4.0, kMostMissed = 5.0;
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

/// Every so many-th of a smoothed channel.
struct Kept {
  std::vector<double> value, rate, acceleration, value_sd, rate_sd, acceleration_sd;
};
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
  const auto every = r.all();
  for (int way = 0; way < 6; ++way) {
    const double step = way < 3 ? kPlaceStep_m : kTurnStep_rad;
    models::FieldMemo memo;
    runtime.respond_at(moved(r.motion, way, step), every, at.deflection_m, there, memo);
    for (std::size_t k = 0; k < n; ++k) {
      const double sd = way < 3 ? r.p_sd_m[k][way] : r.turn_sd_rad[k];
      const Vec6 error = (stacked(there.wrench_H[k]) - stacked(at.wrench_H[k])) * (sd / step);
      out[k] += error * error.transpose();
    }
  }
  return out;
}

/// The rests that the shank may have been in: those it comes to from before and from after, and the
/// one near the bending that the measured force across the probe would make.
std::array<models::PalpationAnswer, 3> possible(const models::PalpationRuntime& runtime,
                                                const PalpationRecording& r) {
  std::array<models::PalpationAnswer, 3> out;
  runtime.predict(r.motion, out[0]);
  runtime.predict(r.motion, out[1], true);
  std::vector<math::Vec2> bent;
  const double per_N =
      1.0 / (runtime.law().parameters().force_scale * runtime.law().tip_stiffness_N_per_m());
  for (const Vec6& measured : r.measured) bent.emplace_back(per_N * measured.head<2>());
  runtime.predict_at(r.motion, r.all(), bent, out[2]);
  return out;
}

/// The course through the possible rests that the measured wrench tells of: the least sum of
/// squared errors (no more than kMostMissed² of their usual size each) and of kChange per change of
/// rest [Viterbi1967]. Where a bent shank can rest in several places, when it goes from one to
/// another is decided by less than a model knows.
models::PalpationAnswer followed(const models::PalpationRuntime& runtime,
                                 const PalpationRecording& r) {
  const auto ways = possible(runtime, r);
  const std::size_t n = r.size(), count = ways.size();
  const auto missed = [&](std::size_t way, std::size_t k) {
    const Vec6 error = r.measured[k] - stacked(ways[way].wrench_H[k]);
    return error.cwiseQuotient(r.noise_sd).squaredNorm();
  };
  std::vector<double> usual;
  for (std::size_t k = 0; k < n; ++k) usual.push_back(missed(0, k));
  const auto middle = usual.begin() + std::ptrdiff_t(n / 2);
  std::ranges::nth_element(usual, middle);
  const double unit = std::max(*middle, 6.0);
  const auto same = [&](std::size_t a, std::size_t b, std::size_t k) {
    return (ways[a].deflection_m[k] - ways[b].deflection_m[k]).norm() < kSameRest_m;
  };
  std::vector<std::array<std::uint8_t, 3>> from(n);
  std::array<double, 3> sum{};
  for (std::size_t k = 0; k < n; ++k) {
    std::array<double, 3> next{};
    for (std::size_t b = 0; b < count; ++b) {
      std::size_t best = b;
      for (std::size_t a = 0; a < count && k > 0; ++a) {
        const auto cost = [&](std::size_t w) {
          return sum[w] + (w == b || same(w, b, k - 1) ? 0.0 : kChange);
        };
        if (cost(a) < cost(best)) best = a;
      }
      from[k][b] = std::uint8_t(best);
      const double change = best == b || k == 0 || same(best, b, k - 1) ? 0.0 : kChange;
      next[b] = sum[best] + change + std::min(missed(b, k) / unit, kMostMissed * kMostMissed);
    }
    sum = next;
  }
  models::PalpationAnswer out = ways[0];
  auto way = std::size_t(std::ranges::min_element(sum) - sum.begin());
  for (std::size_t k = n; k-- > 0;) {
    out.wrench_H[k] = ways[way].wrench_H[k];
    out.deflection_m[k] = ways[way].deflection_m[k];
    out.converged[k] = ways[way].converged[k];
    way = from[k][way];
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

/// Samples before and after which a snap may have been.
std::size_t snap_reach(const PalpationRecording& r) {
  return 1 + std::size_t(kSnapKnown_s * double(r.size() - 1) / r.seconds());
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

/// From a force at the tip of the unbent shank to the wrench that is felt.
Eigen::Matrix<double, 6, 3> lever(const models::PalpationRuntime& runtime) {
  const laws::PalpationParameters& base = runtime.law().parameters();
  const double length = base.length_m * base.torque_scale / base.force_scale;
  Eigen::Matrix<double, 6, 3> out;
  out << math::Mat3::Identity(), length * (math::Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 0).finished();
  return out;
}

/// Covariance of a sample's wrench by what is not known of where a pressed point moves: a force
/// with the velocity's direction in it (friction across the wall's normal, a loss along it) of
/// kRubbing of the contact force may point elsewhere. Taken to act at the tip.
Mat6 by_direction(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                  const models::PalpationAnswer& at, std::size_t k) {
  const double force_N = at.wrench_H[k].force_N.norm();
  if (force_N < kContact_N) return Mat6::Zero();
  const laws::PalpationParameters& base = runtime.law().parameters();
  const math::Quat to_H = r.motion.handle[k].X_VH.q.conjugate();
  const Vec3 n = at.wrench_H[k].force_N / force_N;
  const Vec3 v = to_H * unbent_tip(runtime, r.motion.handle[k]).v_m_s;
  const double along = std::abs(v.dot(n)), across = (v - v.dot(n) * n).norm();
  const double sd = std::max(1e-9, std::hypot(r.v_sd_m_s[k], base.length_m * r.omega_sd_rad_s[k]));
  const double turned = 1.0 / std::max(1.0, across / sd), size = kRubbing * force_N;
  const double reversed = 2.0 * std::exp(-0.5 * (along / sd) * (along / sd));
  math::Mat3 force = n * n.transpose();
  force = size * size *
          (turned * turned * (math::Mat3::Identity() - force) + reversed * reversed * force).eval();
  return lever(runtime) * force * lever(runtime).transpose();
}

/// What a sample's points feel within kEdge_voxels of the volume's edge or beyond it, N: nobody
/// knows how bone goes on there.
double at_the_edge_N(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                     const models::PalpationAnswer& at, std::size_t k) {
  const laws::PalpationParameters& base = runtime.law().parameters();
  const volume::Geometry& grid = runtime.field().geometry();
  math::Pose placed = r.motion.handle[k].X_VH;
  placed.p += base.pose_offset_m;
  double most_per_m = 0.0;
  for (int i = 0; i < base.points; ++i) {
    const Vec3 p = placed * runtime.law().point_H_m(i, at.deflection_m[k]), u = grid.index_of(p);
    Vec3 inside = u;
    for (int a = 0; a < 3; ++a) {
      const double last = grid.dims[std::size_t(a)] - 1;
      inside[a] = std::clamp(u[a], std::min(kEdge_voxels, 0.5 * last),
                             std::max(last - kEdge_voxels, 0.5 * last));
    }
    if (inside == u) continue;
    most_per_m = std::max({most_per_m, runtime.field().gradient_per_m(p).norm(),
                           runtime.field().gradient_per_m(grid.position_of(inside)).norm()});
  }
  return base.force_scale * base.force_factor_Nm * most_per_m;
}

/// Trusted samples, the floor over them, and |g| where the tip touches.
void set_trust(const models::PalpationRuntime& runtime, PalpationRecording& r,
               const models::PalpationAnswer& at, const std::vector<Mat6>& by_motion,
               const std::vector<std::size_t>& snapped) {
  const Vec6 sensor = r.noise_sd.cwiseAbs2();
  const double most_N = std::sqrt(sensor.head<3>().sum());
  const double most = std::pow(kPoorlyKnown * most_N, 2);
  for (std::size_t k = 0; k < r.size(); ++k)
    r.trusted[k] = at.converged[k] && by_motion[k].topLeftCorner<3, 3>().trace() <= most &&
                           at_the_edge_N(runtime, r, at, k) <= most_N &&
                           kMass_kg * r.a_sd_m_s2[k] <= most_N && !sign_unknown(runtime, r, at, k)
                       ? 1.0
                       : 0.0;
  const std::size_t reach = snap_reach(r);
  for (const std::size_t k : snapped)
    for (std::size_t i = k - std::min(k, reach); i < std::min(r.size(), k + reach); ++i)
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

std::vector<std::size_t> PalpationRecording::all() const {
  std::vector<std::size_t> out(size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = k;
  return out;
}

Result<PalpationRecording> prepare(trial::PalpationMeasurement&& trial, const Vec3& down,
                                   const std::string& where, std::size_t most_samples) {
  PalpationRecording out;
  const std::size_t recorded = trial.t_s.size();
  if (recorded < kFewestSamples)
    return wrong(where,
                 fmt::format("{} samples, at least {} are expected", recorded, kFewestSamples));
  if (recorded > most_samples) {
    cut(trial, most_samples);
    out.note = fmt::format(
        "{}: {} samples are more than needed; the {} s from {:.1f} s on, where the "
        "force changes most, were compared",
        trial.id, recorded, std::lround(trial.t_s.back() - trial.t_s.front()), trial.t_s.front());
  }
  const std::size_t n = trial.t_s.size();
  const double spacing_s = (trial.t_s.back() - trial.t_s.front()) / double(n - 1);
  if (spacing_s * kSlowestRate_Hz > 1.001)
    return wrong(where, fmt::format("{:.3g} samples per second, at least {} are expected",
                                    1.0 / spacing_s, kSlowestRate_Hz));
  out.id = trial.id;
  const auto stride = std::size_t(std::max(1.0, std::ceil(0.999 / (spacing_s * kFastest_Hz))));
  smooth_poses(trial, down, stride, out);
  std::vector<double> column(n);
  for (int c = 0; c < 6; ++c) {
    for (std::size_t k = 0; k < n; ++k) column[k] = stacked(trial.wrench_H[k])[c];
    out.noise_sd[c] = noise_of(column);
  }
  for (std::size_t k = 0; k < n; k += stride) out.measured.push_back(stacked(trial.wrench_H[k]));
  out.trusted.assign(out.size(), 1.0);
  choose_instants(out, 1);
  return out;
}

void choose_instants(PalpationRecording& r, std::size_t stride) {
  r.instants.clear();
  for (std::size_t k = stride / 2; k < r.size(); k += stride) r.instants.push_back(k);
  r.whitener.assign(r.instants.size(), Mat6::Identity());
}

void weigh(const models::PalpationRuntime& runtime, PalpationRecording& r) {
  const models::PalpationAnswer at = followed(runtime, r);
  r.deflection_m = at.deflection_m;
  const auto by_motion = motion_covariance(runtime, r, at);
  const auto snapped = snaps(runtime, r, at);
  set_trust(runtime, r, at, by_motion, snapped);
  const Vec6 sensor = r.noise_sd.cwiseAbs2();
  r.usual_square = 0.0;
  const std::size_t reach = snap_reach(r);
  for (std::size_t j = 0; j < r.whitener.size(); ++j) {
    const std::size_t now = r.instants[j];
    Mat6 known = by_motion[now];
    known.diagonal() += sensor;
    const double edge_N = at_the_edge_N(runtime, r, at, now);
    const double unknown_N = std::hypot(kMass_kg * r.a_sd_m_s2[now], edge_N);
    Mat6 expected = known + by_direction(runtime, r, at, now);
    expected += unknown_N * unknown_N * lever(runtime) * lever(runtime).transpose();
    for (const std::size_t k : snapped)
      if (k <= now + reach && now < k + reach) {
        const Vec6 jump = stacked(at.wrench_H[k]) - stacked(at.wrench_H[k - 1]);
        expected += jump * jump.transpose();
      }
    const Eigen::LLT<Mat6> root(expected);
    r.whitener[j] = root.matrixL().solve(Mat6::Identity());
    r.usual_square += (r.whitener[j] * known * r.whitener[j].transpose()).trace() /
                      (6.0 * double(r.whitener.size()));
  }
}

}  // namespace lab
