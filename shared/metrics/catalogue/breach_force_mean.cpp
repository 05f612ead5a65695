#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_force_mean() {
  return {"breach_force_mean",
          "Breach force, mean",
          "N",
          "Mean push of the hand on the probe "
          "over the first breach: the samples from the first to the last in which the controller "
          "is in breach.",
          "[Probing, Table 7], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_breach(subject, 1, [](std::span<const trial::ProbingSample> s) {
              return spread_of(s, push_N).mean;
            });
          }};
}

}  // namespace tractus::metrics
