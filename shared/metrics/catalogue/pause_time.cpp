#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo pause_time() {
  return {"pause_time",
          "Time in pauses",
          "s",
          "Total time of the stretches of at least 0.1 s within the motion "
          "in which the speed, averaged over 0.1 s, is below 1 mm/s; rest at either end is none.",
          "[Probing, section 5] asks for a single motion; thresholds our own",
          trial::Rig::probing,
          [](const Subject& subject) -> Score {
            const auto motion = probing_motion(subject.trial);
            if (motion.empty()) return {{}, "the probe never turned fast enough to move"};
            return {double(pauses_of(motion, subject.trial.header.rate_Hz).total_s), ""};
          }};
}

}  // namespace tractus::metrics
