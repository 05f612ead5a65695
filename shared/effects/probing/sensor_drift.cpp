/// A slow trend of the force sensor over a trial.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

/// In measurements the course is free, differs from trial to trial, and is found from the
/// residuals. As a model alone knows only its range, it is replayed as a straight ramp of that
/// range over the trial, centred at zero.
class SensorDrift final : public ForceSensor {
 public:
  explicit SensorDrift(std::span<const double> values) : range_N_(values[0]) {}
  void record(const ProbingMotion& motion, std::span<double> fz_N) const override {
    if (motion.t_s.empty()) return;
    const double start_s = motion.t_s.front(), length_s = motion.t_s.back() - start_s;
    if (!(length_s > 0.0)) return;
    for (std::size_t k = 0; k < fz_N.size(); ++k)
      fz_N[k] += range_N_ * ((motion.t_s[k] - start_s) / length_s - 0.5);
  }

 private:
  double range_N_;
};

}  // namespace

ProbingEffectInfo sensor_drift() {
  return {
      {.id = "sensor_drift",
       .label = "sensor drift",
       .kind = Kind::measurement,
       .summary = "A slow trend of the force sensor, free in each trial",
       .equation = "d(t) slow; replayed as range ((t − t_0)/T − 1/2)",
       .source = "own",
       .experiment = "two long trials of 60 s of the same stroke, with free air at their ends",
       .params = {{.name = "range_N",
                   .meaning = "from the trend's least to its greatest value over a trial; below 0 "
                              "it falls",
                   .initial = 0.5,
                   .low = -100.0,
                   .high = 100.0}},
       .parents = {"sensor_bias"},
       .free_per_trial = true},
      made<ForceSensor, SensorDrift>};
}

}  // namespace effects::probing
}  // namespace tractus
