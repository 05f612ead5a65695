#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_velocity_mean() {
  return {"breach_velocity_mean",
          "Breach velocity, mean",
          "m/s",
          "Mean speed of the actuator "
          "over the first breach: the samples from the first to the last in which the controller "
          "is in breach.",
          "own definition",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_breach(subject, 1, [](std::span<const trial::ProbingSample> s) {
              return spread_of(s, speed_m_s).mean;
            });
          }};
}

}  // namespace tractus::metrics
