#include <algorithm>
#include <cmath>

#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_velocity_peak() {
  return {"breach_velocity_peak",
          "Breach velocity, peak",
          "m/s",
          "Greatest magnitude of the actuator's speed "
          "over the first breach: the samples from the first to the last in which the controller "
          "is in breach.",
          "[Probing, Table 7], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_breach(subject, 1, [](std::span<const trial::ProbingSample> s) {
              const Spread spread = spread_of(s, speed_m_s);
              return std::max(std::abs(spread.least), std::abs(spread.most));
            });
          }};
}

}  // namespace tractus::metrics
