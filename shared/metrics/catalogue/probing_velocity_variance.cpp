#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo probing_velocity_variance() {
  return {"probing_velocity_variance",
          "Velocity variance",
          "m^2/s^2",
          "Variance (n - 1) of the actuator's speed along the bone, "
          "from the first motion that is let through to the probe stop.",
          "[Probing, section 6.3], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_motion(subject, 2, [](std::span<const trial::ProbingSample> s) {
              return spread_of(s, speed_m_s).variance;
            });
          }};
}

}  // namespace tractus::metrics
