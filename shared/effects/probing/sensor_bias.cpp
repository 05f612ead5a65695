/// A constant that the force sensor adds: F_0.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class SensorBias final : public ForceSensor {
 public:
  explicit SensorBias(std::span<const double> values) : force_N_(values[0]) {}
  void record(const ProbingMotion&, std::span<double> fz_N) const override {
    for (double& force_N : fz_N) force_N += force_N_;
  }

 private:
  double force_N_;
};

}  // namespace

ProbingEffectInfo sensor_bias() {
  return {{.id = "sensor_bias",
           .label = "sensor bias",
           .kind = Kind::measurement,
           .summary = "A constant that the force sensor adds",
           .equation = "F_0",
           .source = "own",
           .experiment = "five seconds in free air before and after, in the same trial",
           .params = {{.name = "force_N",
                       .meaning = "F_0, what the sensor says of no force",
                       .initial = 0.5,
                       .low = -100.0,
                       .high = 100.0}},
           .is_bias = true},
          made<ForceSensor, SensorBias>};
}

}  // namespace effects::probing
}  // namespace tractus
