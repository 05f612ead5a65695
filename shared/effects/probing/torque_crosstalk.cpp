/// The sensor shows a part of the torque as force: F = c t_z, t_z as recorded.
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects::probing {
namespace {

class TorqueCrosstalk final : public ForceSensor {
 public:
  explicit TorqueCrosstalk(std::span<const double> values) : coefficient_per_m_(values[0]) {}
  /// Nothing where no torque was recorded.
  void record(const ProbingMotion& motion, std::span<double> fz_N) const override {
    if (motion.tz_Nm.size() != fz_N.size()) return;
    for (std::size_t k = 0; k < fz_N.size(); ++k) fz_N[k] += coefficient_per_m_ * motion.tz_Nm[k];
  }

 private:
  double coefficient_per_m_;
};

}  // namespace

ProbingEffectInfo torque_crosstalk() {
  return {{.id = "torque_crosstalk",
           .label = "torque crosstalk",
           .kind = Kind::measurement,
           .summary = "The sensor shows a part of the torque as force",
           .equation = "c t_z",
           .source = "own",
           .experiment = "turning to and fro in place, without feed, in free air and in the bone",
           .params = {{.name = "coefficient_per_m",
                       .meaning = "c, force shown per torque",
                       .initial = 5.0,
                       .low = -1000.0,
                       .high = 1000.0}},
           .needs = {"tz_Nm"}},
          made<ForceSensor, TorqueCrosstalk>};
}

}  // namespace effects::probing
}  // namespace tractus
