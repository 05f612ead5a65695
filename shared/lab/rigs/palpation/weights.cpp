#include "lab/rigs/palpation/weights.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "lab/rigs/palpation/noise.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using math::Vec3;

constexpr const auto& kWeights = kSettings.palpation_weights;
/// Median of the sum of squares of two normal numbers over its mean: of χ² with 2 degrees of freedom, over 2.
constexpr double kMedianOfTwoSquares = 0.6931;

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
    const double step = way < 3 ? kWeights.place_step_m : kWeights.turn_step_rad;
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
std::array<models::PalpationAnswer, kWeights.candidates> possible(
    const models::PalpationRuntime& runtime, const PalpationRecording& r) {
  std::array<models::PalpationAnswer, kWeights.candidates> out;
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
/// squared errors (no more than kWeights.most_errors² of their usual size each) and of
/// kWeights.change_cost per change of rest [Viterbi1967]. Where a bent shank can rest in several
/// places, when it goes from one to another is decided by less than a model knows.
class Course {
 public:
  Course(const models::PalpationRuntime& runtime, const PalpationRecording& r)
      : r_(r), ways_(possible(runtime, r)) {
    std::vector<double> all;
    for (std::size_t k = 0; k < r.size(); ++k) all.push_back(squares(0, k));
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::ranges::nth_element(all, middle);
    usual_ = std::max(*middle, 6.0);
  }

  /// Samples at which the shank may rest in several places.
  std::vector<bool> several() const {
    std::vector<bool> out(r_.size());
    for (std::size_t k = 0; k < r_.size(); ++k)
      for (std::size_t way = 1; way < kWeights.candidates; ++way)
        if ((ways_[way].deflection_m[k] - ways_[0].deflection_m[k]).norm() >
            kWeights.other_equilibrium_m)
          out[k] = true;
    return out;
  }

  models::PalpationAnswer best() const {
    std::vector<std::array<std::size_t, kWeights.candidates>> from(r_.size());
    std::array<double, kWeights.candidates> sum{};
    for (std::size_t k = 0; k < r_.size(); ++k) {
      std::array<double, kWeights.candidates> next{};
      for (std::size_t b = 0; b < kWeights.candidates; ++b) {
        from[k][b] = b;
        for (std::size_t a = 0; a < kWeights.candidates && k > 0; ++a)
          if (sum[a] + change(a, b, k - 1) < sum[from[k][b]] + change(from[k][b], b, k - 1))
            from[k][b] = a;
        next[b] = sum[from[k][b]] + (k > 0 ? change(from[k][b], b, k - 1) : 0.0) +
                  std::min(squares(b, k) / usual_, kWeights.most_errors * kWeights.most_errors);
      }
      sum = next;
    }
    models::PalpationAnswer out = ways_[0];
    auto way = std::size_t(std::ranges::min_element(sum) - sum.begin());
    for (std::size_t k = r_.size(); k-- > 0; way = from[k][way]) {
      out.wrench_H[k] = ways_[way].wrench_H[k];
      out.deflection_m[k] = ways_[way].deflection_m[k];
      out.converged[k] = ways_[way].converged[k];
    }
    return out;
  }

 private:
  /// What is missed of a sample on one way, in squares of the sensor's noise.
  double squares(std::size_t way, std::size_t k) const {
    const Vec6 error = r_.missed(k, ways_[way].wrench_H[k]);
    return error.cwiseQuotient(r_.noise_sd).squaredNorm();
  }
  /// What it costs to go from one way at sample k to another at the next.
  double change(std::size_t from, std::size_t to, std::size_t k) const {
    const bool same = (ways_[from].deflection_m[k] - ways_[to].deflection_m[k]).norm() <
                      kWeights.same_equilibrium_m;
    return from == to || same ? 0.0 : kWeights.change_cost;
  }

  const PalpationRecording& r_;
  std::array<models::PalpationAnswer, kWeights.candidates> ways_;
  double usual_;
};

/// Where the unbent tip is, and how fast.
struct Tip {
  Vec3 p_m, v_m_s;
};
Tip unbent_tip(const models::PalpationRuntime& runtime, const effects::HandleMotion& handle) {
  const Vec3 lever = runtime.law().parameters().length_m * (handle.X_VH.q * Vec3::UnitZ());
  return {handle.X_VH.p + lever, handle.v_m_s + handle.omega_rad_s.cross(lever)};
}

/// What is not known of each sample of a trial.
struct UnknownParts {
  std::vector<Mat6> by_motion;     ///< covariance of the wrench by the pose's error
  std::vector<Mat6> by_direction;  ///< by where its pressed points move
  std::vector<bool> several;       ///< whether the shank may rest in several places
  std::vector<std::size_t> snapped;
};

/// Samples at which the shank has gone to another rest: it moved by far more than the hand.
std::vector<std::size_t> snaps(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                               const models::PalpationAnswer& at) {
  std::vector<std::size_t> out;
  for (std::size_t k = 1; k < r.size(); ++k) {
    const double by_hand = (unbent_tip(runtime, r.motion.handle[k]).p_m -
                            unbent_tip(runtime, r.motion.handle[k - 1]).p_m)
                               .norm();
    if ((at.deflection_m[k] - at.deflection_m[k - 1]).norm() >
        kWeights.snap_ratio * by_hand + kWeights.snap_m)
      out.push_back(k);
  }
  return out;
}

/// Samples before and after which a snap may have been.
std::size_t snap_reach(const PalpationRecording& r) {
  return 1 + std::size_t(kWeights.snap_known_s * double(r.size() - 1) / r.seconds());
}

/// A contact point that bone pushes on.
struct Pressed {
  Vec3 p_H_m, force_V_N, v_V_m_s;  // of the bent shank; as it is felt; of the unbent shank
  double sd_m_s;                   // of the velocity, along any axis
  Vec3 normal() const { return force_V_N.normalized(); }
  double along_m_s() const { return std::abs(v_V_m_s.dot(normal())); }
  double across_m_s() const { return (v_V_m_s - v_V_m_s.dot(normal()) * normal()).norm(); }
};

/// The points of a sample that are pressed by at least `least_N`.
std::vector<Pressed> pressed(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                             const models::PalpationAnswer& at, std::size_t k, double least_N) {
  const laws::PalpationParameters& base = runtime.law().parameters();
  const laws::Shank& shank = runtime.law().shank();
  const effects::HandleMotion& handle = r.motion.handle[k];
  math::Pose placed = handle.X_VH;
  placed.p += base.pose_offset_m;
  std::vector<Pressed> out;
  for (int i = 0; i < base.points; ++i) {
    const Vec3 p_H = runtime.law().point_H_m(i, at.deflection_m[k]);
    const Vec3 force =
        base.force_scale * base.force_factor_Nm * runtime.field().gradient_per_m(placed * p_H);
    if (force.norm() < least_N) continue;
    const double z = shank.z_m[std::size_t(i)];
    out.push_back({p_H, force,
                   handle.v_m_s + handle.omega_rad_s.cross(z * (handle.X_VH.q * Vec3::UnitZ())),
                   std::max(1e-9, std::hypot(r.v_sd_m_s[k], z * r.omega_sd_rad_s[k]))});
  }
  return out;
}

/// From a force at a point of H to the wrench that is felt of it, the force as it is felt.
Eigen::Matrix<double, 6, 3> lever(const models::PalpationRuntime& runtime, const Vec3& p_H_m) {
  const laws::PalpationParameters& base = runtime.law().parameters();
  const Vec3 l = p_H_m * (base.torque_scale / base.force_scale);
  Eigen::Matrix<double, 6, 3> out;
  out << math::Mat3::Identity(),
      (math::Mat3() << 0, -l.z(), l.y(), l.z(), 0, -l.x(), -l.y(), l.x(), 0).finished();
  return out;
}

/// What a trial's forces across the predicted contact force miss of it, as a share of it: friction that the model has not, as
/// far as what is known of motion and sensor does not account for it.
double loss_share_of(const PalpationRecording& r, const models::PalpationAnswer& at,
                     const std::vector<Mat6>& by_motion) {
  std::vector<double> squares;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const Vec3 force = at.wrench_H[k].force_N;
    if (force.norm() < kWeights.pressed_N) continue;
    const Vec3 n = force.normalized();
    const math::Mat3 across = math::Mat3::Identity() - n * n.transpose();
    const math::Mat3 known =
        by_motion[k].topLeftCorner<3, 3>() + math::Mat3(r.sensor_squares().head<3>().asDiagonal());
    const double missed = (across * r.missed(k, at.wrench_H[k]).head<3>()).squaredNorm();
    squares.push_back((missed - (across * known).trace()) / force.squaredNorm());
  }
  if (squares.empty()) return kWeights.least_loss_share;
  const double median = value_at_share(std::move(squares), 0.5);
  return std::clamp(std::sqrt(std::max(0.0, median / kMedianOfTwoSquares)),
                    kWeights.least_loss_share, kWeights.most_loss_share);
}

/// Covariance of a sample's wrench by what is not known of where its pressed points move: a force
/// with the velocity's direction in it (friction across the wall's normal, a loss along it) of
/// `loss_share` of the contact force may point elsewhere.
Mat6 by_direction(const models::PalpationRuntime& runtime, const PalpationRecording& r,
                  const models::PalpationAnswer& at, std::size_t k, double loss_share) {
  const math::Mat3 to_H = r.motion.handle[k].X_VH.q.conjugate().toRotationMatrix();
  Mat6 out = Mat6::Zero();
  for (const Pressed& point : pressed(runtime, r, at, k, kWeights.contact_N)) {
    const double turned = 1.0 / std::max(1.0, point.across_m_s() / point.sd_m_s);
    const double reversed = 2.0 * std::exp(-0.5 * std::pow(point.along_m_s() / point.sd_m_s, 2));
    const double size = loss_share * point.force_V_N.norm();
    const Vec3 n = to_H * point.normal();
    const math::Mat3 along = n * n.transpose();
    const math::Mat3 force =
        size * size *
        (turned * turned * (math::Mat3::Identity() - along) + reversed * reversed * along);
    out += lever(runtime, point.p_H_m) * force * lever(runtime, point.p_H_m).transpose();
  }
  return out;
}

/// What a sample's points feel within kWeights.edge_voxels of the volume's edge or beyond it, N:
/// nobody knows how bone goes on there.
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
      inside[a] = std::clamp(u[a], std::min(kWeights.edge_voxels, 0.5 * last),
                             std::max(last - kWeights.edge_voxels, 0.5 * last));
    }
    if (inside == u) continue;
    most_per_m = std::max({most_per_m, runtime.field().gradient_per_m(p).norm(),
                           runtime.field().gradient_per_m(grid.position_of(inside)).norm()});
  }
  return base.force_scale * base.force_factor_Nm * most_per_m;
}

/// Standard deviation of the force that is not known of each sample: by the motion's errors, and by where friction points.
std::vector<double> unknown_force_N(const std::vector<Mat6>& by_motion,
                                    const std::vector<Mat6>& by_direction) {
  std::vector<double> out(by_motion.size());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = std::sqrt((by_motion[k] + by_direction[k]).topLeftCorner<3, 3>().trace());
  return out;
}

/// Did any channel of the sensor stand at the end of its range?
bool saturated(const PalpationRecording& r, std::size_t k) {
  return std::ranges::find(r.saturated[k], true) != r.saturated[k].end();
}

/// Judged samples, the floor over them, and |g| where the tip touches.
void set_trust(const models::PalpationRuntime& runtime, PalpationRecording& r,
               const models::PalpationAnswer& at, const UnknownParts& unknown) {
  const Vec6 sensor = r.sensor_squares();
  const double sensor_N = std::sqrt(sensor.head<3>().sum());
  const std::vector<double> unknown_N = unknown_force_N(unknown.by_motion, unknown.by_direction);
  const double most_N = std::max(kWeights.poorly_known_factor * sensor_N,
                                 value_at_share(unknown_N, kWeights.least_judged_share));
  for (std::size_t k = 0; k < r.size(); ++k)
    r.judgement[k] = !at.converged[k]     ? Judgement::no_equilibrium
                     : saturated(r, k)    ? Judgement::saturated
                     : unknown.several[k] ? Judgement::at_jump
                     : unknown_N[k] <= most_N && at_the_edge_N(runtime, r, at, k) <= sensor_N
                         ? Judgement::judged
                         : Judgement::unknown_motion;
  const std::size_t reach = snap_reach(r);
  for (const std::size_t k : unknown.snapped)
    for (std::size_t i = k - std::min(k, reach); i < std::min(r.size(), k + reach); ++i)
      r.judgement[i] = Judgement::at_jump;
  r.floor.setZero();
  r.field_per_m.clear();
  double judged = 0.0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (r.judgement[k] == Judgement::judged) {
      r.floor += sensor + Vec6((unknown.by_motion[k] + unknown.by_direction[k]).diagonal());
      judged += 1.0;
    }
    if (at.wrench_H[k].force_N.norm() < kWeights.contact_N) continue;
    const Vec3 tip = runtime.tip_m(r.motion.handle[k].X_VH, at.deflection_m[k]);
    r.field_per_m.push_back(runtime.field().gradient_per_m(tip).norm());
  }
  r.floor = judged > 0.0 ? Vec6((r.floor / judged).cwiseSqrt()) : Vec6(sensor.cwiseSqrt());
}

}  // namespace

void weigh(const models::PalpationRuntime& runtime, PalpationRecording& r) {
  const Course course(runtime, r);
  const models::PalpationAnswer at = course.best();
  r.deflection_m = at.deflection_m;
  UnknownParts unknown{
      motion_covariance(runtime, r, at), {}, course.several(), snaps(runtime, r, at)};
  r.motion_N.clear();
  for (const Mat6& covariance : unknown.by_motion)
    r.motion_N.push_back(std::sqrt(covariance.topLeftCorner<3, 3>().trace()));
  const double loss_share = loss_share_of(r, at, unknown.by_motion);
  for (std::size_t k = 0; k < r.size(); ++k)
    unknown.by_direction.push_back(by_direction(runtime, r, at, k, loss_share));
  set_trust(runtime, r, at, unknown);
  const Vec6 sensor = r.noise_sd.cwiseAbs2();
  r.usual_square = 0.0;
  const std::size_t reach = snap_reach(r);
  for (std::size_t j = 0; j < r.whitener.size(); ++j) {
    const std::size_t now = r.instants[j];
    Mat6 known = unknown.by_motion[now];
    known.diagonal() += sensor;
    const double edge_N = at_the_edge_N(runtime, r, at, now);
    const double unknown_N = std::hypot(kWeights.mass_kg * r.a_sd_m_s2[now], edge_N);
    Mat6 expected = known + unknown.by_direction[now];
    const auto tip = lever(runtime, runtime.law().point_H_m(0, math::Vec2::Zero()));
    expected += unknown_N * unknown_N * tip * tip.transpose();
    for (const std::size_t k : unknown.snapped)
      if (k <= now + reach && now < k + reach) {
        const Vec6 jump = stacked(at.wrench_H[k]) - stacked(at.wrench_H[k - 1]);
        expected += jump * jump.transpose();
      }
    for (int c = 0; c < 6; ++c)
      if (r.saturated[now][std::size_t(c)])
        expected(c, c) += PalpationRecording::kDead * PalpationRecording::kDead;
    const Eigen::LLT<Mat6> root(expected);
    r.whitener[j] = root.matrixL().solve(Mat6::Identity());
    r.usual_square += (r.whitener[j] * known * r.whitener[j].transpose()).trace() /
                      (6.0 * double(r.whitener.size()));
  }
}

}  // namespace lab
}  // namespace tractus
