#include "palpation/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace blind {
namespace {

/// Points of a ball with weights: Gauss–Legendre along the radius (volume measure), a Fibonacci
/// lattice on the sphere.
Vec3 mean_over_ball(const Field& field, const Vec3& centre, double radius_m) {
  constexpr std::array<double, 3> kNode = {0.1127016654, 0.5, 0.8872983346};
  constexpr std::array<double, 3> kWeight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  constexpr int kDirections = 24;
  Vec3 sum(0, 0, 0);
  double total = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (int j = 0; j < kDirections; ++j) {
      const double z = 1.0 - (2.0 * j + 1.0) / kDirections,
                   turn = j * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double s = std::sqrt(1 - z * z), weight = kWeight[k] * kNode[k] * kNode[k];
      sum += weight * field.at(centre + radius_m * kNode[k] *
                                            Vec3(s * std::cos(turn), s * std::sin(turn), z));
      total += weight;
    }
  return sum / total;
}

}  // namespace

PalpationPhysics::PalpationPhysics(const Field& field, const Probe& probe,
                                   std::vector<Hidden> effects)
    : field_(field), probe_(probe), effects_(std::move(effects)) {
  double handle = probe.radius_m, tip = probe.radius_m;
  if (const Hidden* e = find("shank_taper"))
    handle = e->of("handle_radius_m"), tip = e->of("tip_radius_m");
  shank_ = bend(probe, handle, tip);
  if (const Hidden* e = find("shank_curvature"))
    bow_ =
        e->of("bow_m") * Vec2(std::cos(e->of("direction_rad")), std::sin(e->of("direction_rad")));
  shift_ = probe.offset_m;
  if (const Hidden* e = find("pose_offset"))
    shift_ += Vec3(e->of("offset_m", 0), e->of("offset_m", 1), e->of("offset_m", 2));
  points_.resize(static_cast<std::size_t>(probe.points));
  begin();
}

const Hidden* PalpationPhysics::find(const std::string& id) const {
  const auto found = std::ranges::find_if(effects_, [&](const Hidden& e) { return e.id == id; });
  return found == effects_.end() ? nullptr : &*found;
}

void PalpationPhysics::begin() {
  delta_.setZero();
  yielded_.setZero();
  tired_.assign(points_.size(), 0.0);
}

/// The point in the handle's frame.
Vec3 PalpationPhysics::local(std::size_t i, const Vec2& delta) const {
  const double z = shank_.z_m[i], u = z / probe_.length_m;
  const Vec2 side = shank_.shape[i] * delta + u * u * bow_;
  return {side[0], side[1], z};
}

void PalpationPhysics::place(const Pose& pose, const Vec2& delta) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    points_[i].at = pose.o_m + pose.R * local(i, delta) + shift_ - yielded_;
}

/// What the bone does to a point by the field, with the effects that change the contact itself.
Vec3 PalpationPhysics::pushed(std::size_t i, const Vec3& p) const {
  const Hidden* ball = find("tip_ball");
  Vec3 g =
      ball != nullptr && i == 0 ? mean_over_ball(field_, p, ball->of("radius_m")) : field_.at(p);
  if (const Hidden* e = find("contact_nonlinearity"); e != nullptr && g.norm() > 0)
    g *= std::pow(g.norm() / e->of("reference_gradient_per_m"), e->of("exponent") - 1.0);
  if (const Hidden* e = find("anisotropic_stiffness")) {
    const double a = e->of("anisotropy");
    g = g.cwiseProduct(Vec3(1 + a, 1, 1 - a));
  }
  if (const Hidden* e = find("porous_stiffness"))
    g *= std::pow(std::clamp(field_.density(p), 50.0, 2000.0) / 500.0, e->of("exponent"));
  return probe_.force_factor_Nm * g;
}

void PalpationPhysics::press(std::size_t i) {
  Point& point = points_[i];
  point.force = pushed(i, point.at);
  point.late.setZero();
  if (const Hidden* e = find("contact_hysteresis");
      e != nullptr && point.velocity.dot(point.force) > 0)
    point.force *= 1.0 - e->of("loss");
  if (const Hidden* e = find("contact_relaxation")) point.force *= 1.0 - e->of("share") * tired_[i];
  if (const Hidden* e = find("tissue_flap")) {
    const Vec3 centre(e->of("centre_m", 0), e->of("centre_m", 1), e->of("centre_m", 2));
    const Vec3 way(e->of("along", 0), e->of("along", 1), e->of("along", 2));
    const double inside =
        1.0 - (point.at - centre).squaredNorm() / (e->of("reach_m") * e->of("reach_m"));
    if (inside > 0 && point.velocity.dot(way) > 0) point.force -= e->of("force_N") * inside * way;
  }
}

/// Friction and damping, which follow the velocity of the unbent shank's point.
void PalpationPhysics::rub(std::size_t i) {
  Point& point = points_[i];
  Vec3 drag(0, 0, 0);
  bool bends = true;
  if (const Hidden* e = find("contact_friction"); e != nullptr && point.force.norm() > 0) {
    const Vec3 n = point.force.normalized();
    const Vec3 slide = point.velocity - point.velocity.dot(n) * n;
    if (slide.norm() > 1e-9) drag -= e->of("coefficient") * point.force.norm() * slide.normalized();
    bends = e->of("bends_shank") != 0;
  }
  if (const Hidden* e = find("contact_damping")) {
    drag -= e->of("damping_Ns_per_m") * field_.opacity(point.at) * point.velocity;
    bends = e->of("bends_shank") != 0;
  }
  if (bends)
    point.force += drag;
  else
    point.late = drag;
}

Vec2 PalpationPhysics::residual(const Pose& pose, const Vec2& delta) {
  place(pose, delta);
  Vec2 sum = -shank_.stiffness_N_per_m * delta;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    press(i);
    rub(i);
    sum += shank_.shape[i] * (pose.R.transpose() * points_[i].force).head<2>();
  }
  return sum;
}

void PalpationPhysics::settle(const Pose& pose) {
  constexpr double kProbe_m = 2e-7, kLongest_m = 1e-4, kStop_N = 1e-6;
  double brake = 0;
  Vec2 r = residual(pose, delta_);
  for (int i = 0; i < 120; ++i) {
    if (r.norm() < kStop_N) return;
    Eigen::Matrix2d slope;  // −∂r/∂δ
    for (int c = 0; c < 2; ++c)
      slope.col(c) = (r - residual(pose, delta_ + kProbe_m * Vec2::Unit(c))) / kProbe_m;
    const Eigen::Matrix2d even = 0.5 * (slope + slope.transpose());
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(even).eigenvalues()[0];
    const double floor = 0.2 * shank_.stiffness_N_per_m;
    const double damping = brake + std::max(0.0, floor - least) * (least < floor ? 2.0 : 0.0);
    Vec2 way = (slope + damping * Eigen::Matrix2d::Identity()).lu().solve(r);
    if (way.norm() > kLongest_m) way *= kLongest_m / way.norm();
    const Vec2 next = residual(pose, delta_ + way);
    brake = next.norm() > r.norm() ? std::max(2 * brake, shank_.stiffness_N_per_m) : 0.3 * brake;
    delta_ += way;
    r = next;
  }
  ++unsettled_;
}

/// The bone gives way: moves along the push on it.
void PalpationPhysics::yield() {
  const Hidden* e = find("bone_compliance");
  if (e == nullptr) return;
  Vec3 sum(0, 0, 0);
  for (const Point& point : points_) sum += point.force;
  yielded_ += 0.4 * (-e->of("compliance_m_per_N") * sum - yielded_);
}

/// Contact gets tired while it lasts, and recovers.
void PalpationPhysics::relax(double dt_s) {
  const Hidden* e = find("contact_relaxation");
  if (e == nullptr) return;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double goal = points_[i].force.norm() > 0.05 ? 1.0 : 0.0;
    tired_[i] += (1 - std::exp(-dt_s / e->of("time_s"))) * (goal - tired_[i]);
  }
}

/// Weight and inertia of what hangs below the sensor.
void PalpationPhysics::hang(const Pose& before, const Pose& now, const Pose& after, double dt_s,
                            Wrench& out) const {
  constexpr double kGravity = 9.80665;
  const auto add = [&](const Hidden& e, const Vec3& acceleration_V) {
    const Vec3 force = now.R.transpose() * (e.of("mass_kg") * acceleration_V);
    out.force_N += force;
    out.torque_Nm += Vec3(0, 0, e.of("centre_m")).cross(force);
  };
  if (const Hidden* e = find("probe_weight")) add(*e, Vec3(0, 0, -kGravity));
  if (const Hidden* e = find("probe_inertia")) {
    const auto centre = [&](const Pose& p) { return Vec3(p.o_m + e->of("centre_m") * p.R.col(2)); };
    add(*e, -(centre(after) - 2 * centre(now) + centre(before)) / (dt_s * dt_s));
  }
}

Wrench PalpationPhysics::step(const Pose& before, const Pose& now, const Pose& after, double dt_s) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3 straight(0, 0, shank_.z_m[i]);
    points_[i].velocity =
        (after.o_m + after.R * straight - before.o_m - before.R * straight) / (2 * dt_s);
  }
  for (int k = 0; k < (find("bone_compliance") != nullptr ? 4 : 1); ++k) {
    settle(now);
    yield();
  }
  residual(now, delta_);
  Wrench out;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec3 force = now.R.transpose() * (points_[i].force + points_[i].late);
    out.force_N += probe_.force_scale * force;
    out.torque_Nm += probe_.torque_scale * local(i, delta_).cross(force);
  }
  relax(dt_s);
  hang(before, now, after, dt_s, out);
  return out;
}

}  // namespace blind
