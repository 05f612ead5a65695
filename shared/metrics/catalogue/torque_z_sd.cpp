#include "metrics/threshold_statistics.hpp"

namespace tractus::metrics {

MetricInfo torque_z_sd() {
  return {"torque_z_sd",
          "Standard deviation of axial torque",
          "N·m",
          "Standard deviation (n − 1) of |T_z| of the model's wrench on the probe, "
          "in the handle's frame, over the samples strictly above 0.001 N·m.",
          "Zoller2020, Table 2",
          [](const Subject& subject) {
            return wrench_score(subject, WrenchPart::torque_z, Statistic::sd);
          }};
}

}  // namespace tractus::metrics
