#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_velocity_onset() {
  return {
      "breach_velocity_onset",
      "Breach velocity, onset",
      "m/s",
      "Speed of the actuator in the first sample of the first breach, by the controller's mode.",
      "own definition",
      trial::Rig::probing,
      [](const Subject& subject) {
        return score_of_breach(subject, 1, [](std::span<const trial::ProbingSample> s) {
          return speed_m_s(s.front());
        });
      }};
}

}  // namespace tractus::metrics
