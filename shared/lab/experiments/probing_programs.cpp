#include "lab/experiments/probing_programs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus {
namespace lab {
namespace {

/// Builds one program move by move.
class Builder {
 public:
  Builder(const MotionRange& range, std::string name, std::string words, double start_m)
      : range_(range) {
    program_.name = std::move(name);
    program_.words = std::move(words);
    program_.start_m = at_m_ = held(start_m);
  }
  Builder& to(double depth_m, double speed_m_s, double hold_s = 0.0) {
    at_m_ = held(depth_m);
    program_.moves.push_back(
        {at_m_, std::min(speed_m_s, range_.fastest_m_s), at_rad_, turning_rad_s_, hold_s});
    return *this;
  }
  /// In to one depth and back out to another, as often as asked.
  Builder& strokes(double out_m, double in_m, double speed_m_s, int count) {
    for (int k = 0; k < count; ++k) to(in_m, speed_m_s).to(out_m, speed_m_s);
    return *this;
  }
  Builder& turning(double by_rad, double speed_rad_s) {
    at_rad_ += by_rad;
    turning_rad_s_ = speed_rad_s;
    return *this;
  }
  trial::MotionProgram done() const { return program_; }

 private:
  double held(double depth_m) const { return std::clamp(depth_m, range_.least_m, range_.most_m); }

  const MotionRange& range_;
  trial::MotionProgram program_;
  double at_m_ = 0.0, at_rad_ = 0.0, turning_rad_s_ = 1.0;
};

std::string mm(double depth_m) { return fmt::format("{:.3g} mm", 1e3 * depth_m); }

}  // namespace

std::vector<trial::MotionProgram> probing_programs(const MotionRange& range) {
  const double out = range.least_m, in = range.most_m, way = in - out;
  const double middle = out + 0.5 * way, deep = out + 0.75 * way, shallow = out + 0.25 * way;
  const std::string between = fmt::format("between {} and {}", mm(out), mm(in));
  std::vector<trial::MotionProgram> all;
  all.push_back(
      Builder(range, "slow strokes", "slow strokes in and out at 2 and 5 mm/s " + between, out)
          .strokes(out, in, 0.005, 1)
          .strokes(out, in, 0.002, 1)
          .done());
  Builder speeds(range, "strokes at many speeds",
                 "strokes in and out at 1, 2, 5, 10, 20, 40 and 80 mm/s " + between, out);
  for (const double speed : {0.02, 0.08, 0.005, 0.04, 0.01}) speeds.strokes(out, in, speed, 1);
  speeds.strokes(middle, std::min(in, middle + 0.004), 0.002, 1)
      .strokes(middle, std::min(in, middle + 0.003), 0.001, 1);
  all.push_back(speeds.done());
  all.push_back(Builder(range, "quick strokes",
                        "quick strokes of 3 mm at 40 and 80 mm/s, about " + mm(middle), middle)
                    .strokes(middle - 0.0015, middle + 0.0015, 0.04, 20)
                    .strokes(middle - 0.0015, middle + 0.0015, 0.08, 30)
                    .done());
  Builder reversals(range, "reversals",
                    "reversals of 0.1, 0.3, 1 and 3 mm at 2 mm/s, about " + mm(deep), deep);
  for (const double size : {0.003, 0.001, 0.0003, 0.0001})
    reversals.strokes(deep - size, deep, 0.002, 3);
  reversals.strokes(shallow, deep, 0.01, 2);
  all.push_back(reversals.done());
  Builder steps(range, "steps and holds",
                "a staircase: steps at 40 mm/s, each followed by a hold of 3 s, " + between, out);
  for (int k = 1; k <= 4; ++k) steps.to(out + way * k / 4.0, 0.04, 3.0);
  for (int k = 3; k >= 0; --k) steps.to(out + way * k / 4.0, 0.04, 2.0);
  all.push_back(steps.done());
  all.push_back(
      Builder(range, "two depths",
              fmt::format("short strokes of 3 mm at 5 mm/s at {} and at {}", mm(shallow), mm(in)),
              shallow)
          .strokes(shallow, shallow + 0.003, 0.005, 5)
          .to(in - 0.003, 0.02)
          .strokes(in - 0.003, in, 0.005, 5)
          .done());
  all.push_back(Builder(range, "holds at both ends",
                        "strokes at 10 mm/s with holds of 5 s outside and at the deepest place",
                        out)
                    .to(out, 0.01, 5.0)
                    .to(in, 0.01, 5.0)
                    .to(out, 0.01, 5.0)
                    .to(in, 0.01, 5.0)
                    .done());
  if (range.turns) {
    Builder turning(range, "strokes while turning",
                    "the same stroke while turning slowly, fast and not at all " + between, out);
    for (const double speed : {0.5, 3.0, 0.1})
      turning.turning(2.0, speed).to(in, 0.01).turning(-2.0, speed).to(out, 0.01);
    all.push_back(turning.done());
  }
  return all;
}

}  // namespace lab
}  // namespace tractus
