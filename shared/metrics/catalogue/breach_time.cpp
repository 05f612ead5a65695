#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breach_time() {
  return {
      "breach_time",
      "Breach time",
      "s",
      "Number of samples of the first breach, by the controller's mode, times the loop's period.",
      "own definition",
      trial::Rig::probing,
      [](const Subject& subject) -> Score {
        const auto section = first_breach(subject.trial);
        if (section.empty()) return {{}, "no wall was breached"};
        return {double(section.size()) / subject.trial.header.rate_Hz, ""};
      }};
}

}  // namespace tractus::metrics
