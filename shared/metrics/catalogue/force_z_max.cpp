#include "metrics/threshold_statistics.hpp"

namespace tractus::metrics {

MetricInfo force_z_max() {
  MetricInfo info{"force_z_max",
                  "Largest axial force",
                  "N",
                  "Largest value of |F_z| of the model's wrench on the probe, "
                  "in the handle's frame, over the samples strictly above 0.01 N.",
                  "Zoller2020, Table 1",
                  trial::Rig::palpation,
                  [](const Subject& subject) {
                    return wrench_score(subject, WrenchPart::force_z, Statistic::max);
                  }};
  info.cell = wrench_cell(WrenchPart::force_z, Statistic::max);
  return info;
}

}  // namespace tractus::metrics
