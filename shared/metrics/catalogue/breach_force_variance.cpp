#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_force_variance() {
  return {"breach_force_variance",
          "Breach force variance",
          "N^2",
          "Variance (n - 1) of the push of the hand "
          "over the first breach: the samples from the first to the last in which the controller "
          "is in breach.",
          "[Probing, Table 7], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_breach(subject, 2, [](std::span<const trial::ProbingSample> s) {
              return spread_of(s, push_N).variance;
            });
          }};
}

}  // namespace tractus::metrics
