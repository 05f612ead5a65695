#include "metrics/threshold_statistics.hpp"

namespace tractus::metrics {

MetricInfo torque_xy_max() {
  MetricInfo info{"torque_xy_max",
                  "Largest transverse torque",
                  "N·m",
                  "Largest value of T_xy = hypot(T_x, T_y) of the model's wrench on the probe, "
                  "in the handle's frame, over the samples strictly above 0.001 N·m.",
                  "Zoller2020, Table 2",
                  trial::Rig::palpation,
                  [](const Subject& subject) {
                    return wrench_score(subject, WrenchPart::torque_xy, Statistic::max);
                  }};
  info.cell = wrench_cell(WrenchPart::torque_xy, Statistic::max);
  return info;
}

}  // namespace tractus::metrics
