/// A constant that the force sensor adds: F_0.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class SensorBias final : public ProbingEffect {
 public:
  explicit SensorBias(std::span<const double> values) : force_N_(values[0]) {}
  ProbingStage stage() const noexcept override { return ProbingStage::recording; }
  void record(const ProbingMotion&, std::span<double> fz_N) const override {
    for (double& force_N : fz_N) force_N += force_N_;
  }

 private:
  double force_N_;
};

}  // namespace

ProbingEffectInfo sensor_bias() {
  return {{.id = "sensor_bias",
           .kind = Kind::measurement,
           .summary = "A constant that the force sensor adds",
           .equation = "F_0",
           .source = "own",
           .params = {{.name = "force_N",
                       .meaning = "F_0, what the sensor says of no force",
                       .initial = 0.5,
                       .low = -100.0,
                       .high = 100.0}}},
          made<SensorBias>};
}

}  // namespace effects::probing
}  // namespace tractus
