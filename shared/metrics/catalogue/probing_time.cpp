#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo probing_time() {
  return {"probing_time",
          "Probing time",
          "s",
          "Time from the first motion that is let through (the probe turns faster than 10 deg/s) "
          "to the "
          "probe stop, or to the end.",
          "[Probing, section 6.3], definition our own",
          trial::Rig::probing,
          [](const Subject& subject) {
            return score_of_motion(subject, 1, [](std::span<const trial::ProbingSample> s) {
              return s.back().t_s - s.front().t_s;
            });
          }};
}

}  // namespace tractus::metrics
