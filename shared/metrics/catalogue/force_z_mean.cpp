#include "metrics/threshold_statistics.hpp"

namespace tractus::metrics {

MetricInfo force_z_mean() {
  MetricInfo info{"force_z_mean",
                  "Mean axial force",
                  "N",
                  "Mean of |F_z| of the model's wrench on the probe, "
                  "in the handle's frame, over the samples strictly above 0.01 N.",
                  "Zoller2020, Table 1",
                  trial::Rig::palpation,
                  [](const Subject& subject) {
                    return wrench_score(subject, WrenchPart::force_z, Statistic::mean);
                  }};
  info.cell = wrench_cell(WrenchPart::force_z, Statistic::mean);
  return info;
}

}  // namespace tractus::metrics
