#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo probing_force_variance() {
  MetricInfo info{"probing_force_variance",
                  "Force variance",
                  "N^2",
                  "Variance (n - 1) of the push of the hand on the probe, "
                  "from the first motion that is let through to the probe stop.",
                  "[Probing, section 6.3], definition our own",
                  trial::Rig::probing,
                  [](const Subject& subject) {
                    return score_of_motion(subject, 2, [](std::span<const trial::ProbingSample> s) {
                      return spread_of(s, push_N).variance;
                    });
                  }};
  info.followed = 4;
  return info;
}

}  // namespace tractus::metrics
