#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_velocity_variance() {
  return {"breach_velocity_variance",
          "Breach velocity variance",
          "m^2/s^2",
          "Variance (n - 1) of the actuator's speed "
          "over the first breach: the samples from the first to the last in which the controller "
          "is in breach.",
          "[Probing, Table 7], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_breach(subject, 2, [](std::span<const trial::ProbingSample> s) {
              return spread_of(s, speed_m_s).variance;
            });
          }};
}

}  // namespace tractus::metrics
