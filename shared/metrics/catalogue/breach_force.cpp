#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_force() {
  MetricInfo info{
      "breach_force",
      "Breach force",
      "N",
      "Push of the hand on the probe in the last sample before the first breach: what the bone "
      "gave way to.",
      "[Probing, section 4], definition our own",
      trial::Rig::probing,
      [](const Subject& subject) -> Score {
        const auto section = first_breach(subject.trial);
        if (section.empty()) return {{}, "no wall was breached"};
        if (section.data() == subject.trial.probing.data())
          return {{}, "the recording begins in a breach"};
        return {push_N(*(section.data() - 1)), ""};
      }};
  info.followed = 5;
  return info;
}

}  // namespace tractus::metrics
