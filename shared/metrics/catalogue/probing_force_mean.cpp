#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo probing_force_mean() {
  MetricInfo info{"probing_force_mean",
                  "Mean force",
                  "N",
                  "Mean push of the hand on the probe, "
                  "from the first motion that is let through to the probe stop.",
                  "[Probing, section 6.3], definition our own",
                  trial::Rig::probing,
                  [](const Subject& subject) {
                    return score_of_motion(subject, 1, [](std::span<const trial::ProbingSample> s) {
                      return spread_of(s, push_N).mean;
                    });
                  }};
  info.followed = 2;
  return info;
}

}  // namespace tractus::metrics
