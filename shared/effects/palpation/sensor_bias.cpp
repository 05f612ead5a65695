/// A sensor that says something while nothing pulls: a constant force and torque in its own frame.
#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

class SensorBias final : public SensorOffset {
 public:
  SensorBias(const Vec3& force_N, const Vec3& torque_Nm) : bias_H_{force_N, torque_Nm} {}

  void add(math::Wrench& wrench_H) const noexcept override {
    wrench_H.force_N += bias_H_.force_N;
    wrench_H.torque_Nm += bias_H_.torque_Nm;
  }

 private:
  math::Wrench bias_H_;
};

Param bias(const char* name, const char* meaning, double most, double step) {
  return {.name = name,
          .meaning = meaning,
          .initial = 0.0,
          .low = -most,
          .high = most,
          .components = 3,
          .step = step};
}

}  // namespace

namespace palpation {
PalpationEffectInfo sensor_bias() {
  return {.facts = {.id = "sensor_bias",
                    .label = "sensor bias",
                    .kind = Kind::measurement,
                    .summary = "A constant that the sensor adds to force and torque",
                    .equation = "recorded = true + (force, torque), in H",
                    .source = "own",
                    .experiment = "five seconds in free air before and after, at several tilts",
                    .params = {bias("force_N", "added to the force, x y z of H", 50.0, 1e-2),
                               bias("torque_Nm", "added to the torque, x y z of H", 5.0, 1e-3)},
                    .is_bias = true,
                    .starts = {{1e-2, 1e-2, 1e-2, 1e-3, 1e-3, 1e-3}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<SensorBias>(Vec3(values[0], values[1], values[2]),
                                                Vec3(values[3], values[4], values[5]));
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
