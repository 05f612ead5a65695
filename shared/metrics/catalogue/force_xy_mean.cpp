#include "metrics/threshold_statistics.hpp"

namespace tractus::metrics {

MetricInfo force_xy_mean() {
  MetricInfo info{"force_xy_mean",
                  "Mean transverse force",
                  "N",
                  "Mean of F_xy = hypot(F_x, F_y) of the model's wrench on the probe, "
                  "in the handle's frame, over the samples strictly above 0.01 N.",
                  "Zoller2020, Table 1",
                  trial::Rig::palpation,
                  [](const Subject& subject) {
                    return wrench_score(subject, WrenchPart::force_xy, Statistic::mean);
                  }};
  info.cell = wrench_cell(WrenchPart::force_xy, Statistic::mean);
  info.followed = 3;
  return info;
}

}  // namespace tractus::metrics
