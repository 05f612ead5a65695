#include "probing/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/path.hpp"

namespace blind {
namespace {

std::size_t steps_of(const TrialPlan& plan) {
  return static_cast<std::size_t>(std::lround(plan.duration_s / kFineStep_s)) + 1;
}

/// Fills angle and its speed; sets the times.
void turn(Series& series, const Path& angle) {
  for (std::size_t i = 0; i < series.moments.size(); ++i) {
    Moment& m = series.moments[i];
    m.t_s = static_cast<double>(i) * kFineStep_s;
    m.theta_rad = angle.at(m.t_s);
    m.omega_rad_s =
        (angle.at(m.t_s + kFineStep_s) - angle.at(m.t_s - kFineStep_s)) / (2 * kFineStep_s);
  }
}

/// Where the hand means to be: the path, its tremor, and the push that it has learned to give
/// against this bone.
class Hand {
 public:
  Hand(const TrialPlan& plan, Random random, const Base& base)
      : path_(probing_path(random, plan.low_m, plan.high_m, plan.duration_s, Stroke::kMinimumJerk)),
        tremor_(tremor(random, plan.tremor_m)),
        stiffness_(plan.hand_N_per_m),
        bone_(base, {}, 0) {
    lean_N_ = expected(0.0);
  }
  double start() const { return path_.at(0.0); }
  double force(double t_s, double x_m) {
    lean_N_ += kFineStep_s / kLearned_s * (expected(t_s) - lean_N_);
    return stiffness_ * (path_.at(t_s) + tremor_.at(t_s) - x_m) + lean_N_;
  }

 private:
  static constexpr double kLearned_s = 0.08;
  double expected(double t_s) const {
    Moment m;
    m.x_m = path_.at(t_s);
    m.v_m_s = (path_.at(t_s + kFineStep_s) - m.x_m) / kFineStep_s;
    return bone_.force(m);
  }
  Path path_;
  MultiSine tremor_;
  double stiffness_;
  Physics bone_;
  double lean_N_ = 0;
};

/// Speed at which the resistance equals a push, without mass: the root of D v + c v² = |push| −
/// friction.
double speed_under(double push_N, const Resistance& r) {
  const double left = std::abs(push_N) - r.friction_N;
  if (left <= 0) return 0;
  const double d = r.damping_Ns_per_m;
  const double root = r.drag_Ns2_per_m2 > 0
                          ? 2 * left / (d + std::sqrt(d * d + 4 * r.drag_Ns2_per_m2 * left))
                          : left / d;
  return sign_of(push_N) * root;
}

/// One fine step of the hand against the bone. Returns the moment after it.
Moment advance(const Moment& m, double push_N, const Resistance& r) {
  Moment to = m;
  if (r.mass_kg > 0) {
    const double damping = r.damping_Ns_per_m + r.drag_Ns2_per_m2 * std::abs(m.v_m_s);
    const double rate = kFineStep_s / r.mass_kg;
    to.v_m_s = (m.v_m_s + rate * (push_N - r.rest_N)) / (1.0 + rate * damping);
    to.x_m = m.x_m + 0.5 * kFineStep_s * (m.v_m_s + to.v_m_s);
  } else {
    to.x_m = m.x_m + kFineStep_s * m.v_m_s;
  }
  to.t_s = m.t_s + kFineStep_s;
  return to;
}

Series pushed_by_hand(const TrialPlan& plan, Physics& physics, const TrialContext& trial) {
  Random random(plan.seed);
  Series series;
  series.moments.resize(steps_of(plan));
  turn(series, turning_path(random, plan.duration_s));
  Hand hand(plan, random.split(), physics.base());
  series.moments.front().x_m = hand.start();
  physics.begin(trial, series.moments.front());
  std::size_t stuck = 0;
  for (std::size_t i = 0; i < series.moments.size(); ++i) {
    Moment& m = series.moments[i];
    const double push = hand.force(m.t_s, m.x_m);
    const Resistance r = physics.at(m);
    if (r.mass_kg == 0) m.v_m_s = speed_under(push - r.rest_N, r);
    stuck += r.friction_N > 0 && m.v_m_s == 0;
    series.force_N.push_back(push);
    if (i + 1 == series.moments.size()) break;
    const Moment after = advance(m, push, r);
    m.a_m_s2 = (after.v_m_s - m.v_m_s) / kFineStep_s;
    series.moments[i + 1].x_m = after.x_m;
    series.moments[i + 1].v_m_s = after.v_m_s;
    physics.step(m, series.moments[i + 1]);
  }
  series.stuck_share = static_cast<double>(stuck) / static_cast<double>(series.moments.size());
  return series;
}

/// Three equal lags in a row: the path becomes smooth to its acceleration.
void smooth(Series& series, double corner_Hz) {
  const double w = 2.0 * std::numbers::pi * corner_Hz;
  double y[3];
  std::fill(std::begin(y), std::end(y), series.moments.front().x_m);
  for (Moment& m : series.moments) {
    const double d0 = w * (m.x_m - y[0]), d1 = w * (y[0] - y[1]), d2 = w * (y[1] - y[2]);
    m = {m.t_s, y[2], d2, w * (d1 - d2), m.theta_rad, m.omega_rad_s};
    y[0] += kFineStep_s * d0;
    y[1] += kFineStep_s * d1;
    y[2] += kFineStep_s * d2;
  }
}

/// Speed and acceleration of a path given by its places.
void differentiate(Series& series) {
  auto& m = series.moments;
  for (std::size_t i = 1; i + 1 < m.size(); ++i) {
    m[i].v_m_s = (m[i + 1].x_m - m[i - 1].x_m) / (2 * kFineStep_s);
    m[i].a_m_s2 = (m[i + 1].x_m - 2 * m[i].x_m + m[i - 1].x_m) / (kFineStep_s * kFineStep_s);
  }
  m.front().v_m_s = m[1].v_m_s;
  m.back().v_m_s = m[m.size() - 2].v_m_s;
}

Series programmed(const TrialPlan& plan) {
  Random random(plan.seed);
  Series series;
  series.moments.resize(steps_of(plan));
  turn(series, turning_path(random, plan.duration_s));
  const double swing = random.chance(0.6) ? 0.12 * (plan.high_m - plan.low_m) : 0.0;
  Path path = probing_path(random, plan.low_m + swing, plan.high_m - swing, plan.duration_s,
                           random.chance(0.5) ? Stroke::kRamp : Stroke::kMinimumJerk);
  MultiSine sines = random.chance(0.6) ? tremor(random, 0.5 * plan.tremor_m) : MultiSine{};
  constexpr int kLines = 6;
  for (int i = 0; swing > 0 && i < kLines; ++i) {
    const double frequency = random.log_uniform(0.2, 6.0);
    sines.add(swing / kLines / std::max(1.0, frequency), frequency, random.uniform(0, 6.28));
  }
  for (Moment& m : series.moments) {
    const double shifted = m.t_s - plan.air_s;
    m.x_m = path.at(std::max(0.0, shifted)) + (shifted > 0 ? sines.at(shifted) : 0.0);
  }
  if (plan.air_s > 0) {  // comes in from the open
    Path entry(-random.uniform(5e-4, 3e-3));
    entry.hold(0.6 * plan.air_s);
    entry.stroke(path.at(0.0), 0.4 * plan.air_s, Stroke::kMinimumJerk);
    for (Moment& m : series.moments)
      if (m.t_s < plan.air_s) m.x_m = entry.at(m.t_s);
  }
  differentiate(series);
  return series;
}

}  // namespace

Series move(const TrialPlan& plan, Physics& physics, const TrialContext& trial) {
  if (plan.mode == Mode::kProgrammed) return programmed(plan);
  if (plan.mode == Mode::kHand) return pushed_by_hand(plan, physics, trial);
  Physics bone(physics.base(), {}, 0);
  Series series = pushed_by_hand(plan, bone, trial);
  smooth(series, plan.smoothing_Hz);
  series.force_N.clear();
  return series;
}

std::vector<double> evaluate(const Series& series, Physics& physics, const TrialContext& trial) {
  std::vector<double> out;
  out.reserve(series.moments.size());
  physics.begin(trial, series.moments.front());
  for (std::size_t i = 0; i < series.moments.size(); ++i) {
    out.push_back(physics.force(series.moments[i]));
    if (i + 1 < series.moments.size()) physics.step(series.moments[i], series.moments[i + 1]);
  }
  return out;
}

}  // namespace blind
