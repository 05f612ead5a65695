#pragma once
/// A hand that palpates a tract: taps on walls and end, slides, sweeps, holds, rolls of the handle,
/// in and out.
#include "palpation/law.hpp"
#include "support/path.hpp"

namespace blind {

class Palpation {
 public:
  Palpation(Random random, const Tract& tract, const Probe& probe, double duration_s, double tempo);
  /// The handle at a time; the paths are smooth and may be asked slightly outside the trial.
  Pose at(double t_s) const;

 private:
  struct Goal {
    double depth_m, press_m, around_rad, tilt_a_rad, tilt_b_rad, roll_rad;
  };
  void go(double usual_s);
  void hold(double usual_s) { go(usual_s); }
  void act(Random& random);
  void tap_wall(Random& random);
  void slide(Random& random);
  void sweep(Random& random);
  void tap_end(Random& random);
  void turn(Random& random);
  void in_and_out(Random& random);

  Tract tract_;
  double length_m_, tempo_;
  Goal goal_;
  Path depth_, press_, around_, tilt_a_, tilt_b_, roll_;
  MultiSine shake_[3], sway_[2];
};

}  // namespace blind
