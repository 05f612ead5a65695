#include "metrics/probing_sections.hpp"

namespace tractus::metrics {

MetricInfo breaches() {
  return {"breaches",
          "Breaches",
          "1",
          "Number of times the controller's mode became breach while the probe went inward.",
          "own definition",
          trial::Rig::probing,
          [](const Subject& subject) -> Score {
            if (subject.trial.probing.empty()) return {{}, "no sample was recorded"};
            return {double(breach_count(subject.trial)), ""};
          }};
}

}  // namespace tractus::metrics
