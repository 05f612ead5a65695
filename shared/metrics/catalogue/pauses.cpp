#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo pauses() {
  MetricInfo info{
      "pauses",
      "Pauses",
      "1",
      "Number of stretches of at least 0.1 s within the motion "
      "in which the speed, averaged over 0.1 s, is below 1 mm/s; rest at either end is none.",
      "[Probing, section 5] asks for a single motion; thresholds our own",
      trial::Rig::probing,
      [](const Subject& subject) -> Score {
        const auto motion = probing_motion(subject.trial);
        if (motion.empty()) return {{}, "the probe never turned fast enough to move"};
        return {double(pauses_of(motion, subject.trial.header.rate_Hz).count), ""};
      }};
  info.followed = 6;
  return info;
}

}  // namespace tractus::metrics
