#include "palpation/hand.hpp"

#include <algorithm>
#include <cmath>

namespace blind {

Palpation::Palpation(Random random, const Tract& tract, const Probe& probe, double duration_s,
                     double tempo)
    : tract_(tract),
      length_m_(probe.length_m),
      tempo_(tempo),
      goal_{random.uniform(0.009, 0.014), 2e-4, random.uniform(-3, 3), 0, 0,
            random.uniform(-0.4, 0.4)},
      depth_(goal_.depth_m),
      press_(goal_.press_m),
      around_(goal_.around_rad),
      tilt_a_(0),
      tilt_b_(0),
      roll_(goal_.roll_rad) {
  const double size = random.log_uniform(1.5e-5, 9e-5);
  for (MultiSine& s : shake_) s = tremor(random, size);
  for (MultiSine& s : sway_) s = tremor(random, 2e-4);
  hold(random.uniform(0.1, 0.4));
  while (depth_.end_s() < duration_s + 0.1) act(random);
}

void Palpation::go(double usual_s) {
  const double duration_s = usual_s / tempo_;
  const auto one = [&](Path& path, double to) {
    if (to == path.last())
      path.hold(duration_s);
    else
      path.stroke(to, duration_s, Stroke::kMinimumJerk);
  };
  one(depth_, goal_.depth_m);
  one(press_, goal_.press_m);
  one(around_, goal_.around_rad);
  one(tilt_a_, goal_.tilt_a_rad);
  one(tilt_b_, goal_.tilt_b_rad);
  one(roll_, goal_.roll_rad);
}

void Palpation::act(Random& random) {
  const double u = random.unit();
  if (u < 0.22) return tap_wall(random);
  if (u < 0.44) return slide(random);
  if (u < 0.58) return sweep(random);
  if (u < 0.76) return tap_end(random);
  if (u < 0.88) return turn(random);
  in_and_out(random);
}

void Palpation::tap_wall(Random& random) {
  goal_.around_rad += random.uniform(-2.0, 2.0);
  goal_.press_m = 0.4 * tract_.radius_m;
  go(random.uniform(0.2, 0.5));
  goal_.press_m = tract_.radius_m + random.uniform(3e-4, 3.5e-3);
  go(random.uniform(0.15, 0.4));
  if (random.chance(0.6)) hold(random.uniform(0.1, 0.9));
  goal_.press_m = random.uniform(0.2, 0.7) * tract_.radius_m;
  go(random.uniform(0.15, 0.4));
}

void Palpation::slide(Random& random) {
  goal_.press_m = tract_.radius_m + random.uniform(3e-4, 2.5e-3);
  go(random.uniform(0.2, 0.4));
  for (int i = 0; i < 1 + random.below(2); ++i) {
    const double to = random.uniform(0.008, tract_.depth_m - 0.0015);
    const double way = std::abs(to - goal_.depth_m);
    goal_.depth_m = to;
    go(std::max(0.3, way / random.log_uniform(4e-3, 2.2e-2)));
    if (random.chance(0.4)) hold(random.uniform(0.1, 0.5));
  }
}

void Palpation::sweep(Random& random) {
  goal_.press_m = tract_.radius_m + random.uniform(2e-4, 2e-3);
  go(random.uniform(0.2, 0.4));
  const double way = random.uniform(0.5, 2.6);
  goal_.around_rad += random.sign() * way;
  go(way / random.uniform(1.0, 3.5));
}

void Palpation::tap_end(Random& random) {
  goal_.press_m = random.uniform(0.1, 0.6) * tract_.radius_m;
  goal_.depth_m = tract_.depth_m - 0.0025;
  go(random.uniform(0.4, 1.0));
  const int taps = 1 + random.below(3);
  for (int i = 0; i < taps; ++i) {
    goal_.depth_m = tract_.depth_m + random.uniform(-5e-4, 3e-4);
    go(random.uniform(0.12, 0.35));
    if (random.chance(0.5)) hold(random.uniform(0.1, 0.7));
    goal_.depth_m = tract_.depth_m - random.uniform(1.5e-3, 3e-3);
    go(random.uniform(0.12, 0.35));
  }
}

void Palpation::turn(Random& random) {
  goal_.roll_rad = std::clamp(goal_.roll_rad + random.sign() * random.uniform(0.4, 1.4), -1.4, 1.4);
  goal_.tilt_a_rad = random.uniform(-0.03, 0.03);
  goal_.tilt_b_rad = random.uniform(-0.03, 0.03);
  go(random.uniform(0.4, 1.2));
}

void Palpation::in_and_out(Random& random) {
  goal_.press_m = random.uniform(0.0, 1.0) * tract_.radius_m;
  goal_.depth_m = random.uniform(0.6, 0.94) * tract_.depth_m;
  go(random.uniform(0.4, 1.2));
  goal_.depth_m = random.uniform(0.007, 0.012);
  go(random.uniform(0.5, 1.4));
}

Pose Palpation::at(double t_s) const {
  const double t = std::max(0.0, t_s);
  const double press = press_.at(t), around = around_.at(t);
  const Vec3 tip = tract_.entry_m + (depth_.at(t) + shake_[2].at(t)) * tract_.along +
                   (press * std::cos(around) + shake_[0].at(t)) * tract_.across +
                   (press * std::sin(around) + shake_[1].at(t)) * tract_.up;
  const double a = tilt_a_.at(t) + sway_[0].at(t), b = tilt_b_.at(t) + sway_[1].at(t),
               roll = roll_.at(t);
  Pose pose;
  const Vec3 z = (tract_.along + a * tract_.across + b * tract_.up).normalized();
  const Vec3 x0 = (tract_.across - tract_.across.dot(z) * z).normalized();
  const Vec3 x = std::cos(roll) * x0 + std::sin(roll) * z.cross(x0);
  pose.R.col(0) = x;
  pose.R.col(1) = z.cross(x);
  pose.R.col(2) = z;
  pose.o_m = tip - length_m_ * z;
  return pose;
}

}  // namespace blind
