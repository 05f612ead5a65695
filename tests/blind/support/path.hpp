#pragma once
/// Smooth paths of one coordinate, made of strokes and holds.
#include <vector>

#include "support/random.hpp"

namespace blind {

enum class Stroke { kMinimumJerk, kRamp };

/// Strokes from place to place, each with its own time; between them the value rests.
class Path {
 public:
  explicit Path(double start) : last_(start), start_(start) {}
  void hold(double duration_s) { end_s_ += duration_s; }
  void stroke(double to, double duration_s, Stroke shape);
  double at(double t_s) const;
  double end_s() const { return end_s_; }
  double last() const { return last_; }

 private:
  struct Piece {
    double begin_s, duration_s, from, to;
    Stroke shape;
  };
  std::vector<Piece> pieces_;
  double end_s_ = 0, last_, start_;
};

/// Depth against time as a person probes: deeper and back, holds, small reversals, slow and fast.
Path probing_path(Random& random, double low_m, double high_m, double duration_s, Stroke shape);

/// Angle against time: turns both ways that start, stop and change speed.
Path turning_path(Random& random, double duration_s);

/// Sum of sines; starts softly over half a second.
class MultiSine {
 public:
  void add(double amplitude, double frequency_Hz, double phase_rad);
  double at(double t_s) const;

 private:
  struct Sine {
    double amplitude, rate_rad_s, phase_rad;
  };
  std::vector<Sine> sines_;
};

/// The tremor of a hand: a few lines between 8 and 10 Hz that beat; `amplitude` is its standard
/// deviation.
MultiSine tremor(Random& random, double amplitude);

}  // namespace blind
